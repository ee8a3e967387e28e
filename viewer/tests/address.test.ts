import { Vector3 } from 'three';
import { describe, expect, it } from 'vitest';
import { formatAddress, parseAddress, type Shown } from '../src/stage/address';
import { defaultSettings } from '../src/draw/settings';

const pose = { eye: new Vector3(1, 2.5, -3), target: new Vector3(0, 1, 0), up: new Vector3(0, 1, 0), fov: 39.6 };
const shown: Shown = { pose, settings: defaultSettings, node: null, compare: null, lMax: 20 };

describe('An address', () => {
  it('gives back what was shown', () => {
    const settings = {
      exposure: -1.3, curve: 'filmic', degree: 7, wireframe: true, seeThroughBacks: true,
      falseColour: { quantity: 'irradiance', low: 0.01, high: 30, logarithmic: true },
    } as const;
    const { falseColour, ...plain } = settings;
    const back = parseAddress(formatAddress({ ...shown, pose: { ...pose, up: new Vector3(0, 0, 1) }, settings, node: 12, compare: 40 }));
    expect(back.settings).toEqual(plain);
    expect(back.show).toEqual(falseColour);
    expect([back.node, back.compare]).toEqual([12, 40]);
    expect(back.pose!.eye.toArray()).toEqual([1, 2.5, -3]);
    expect(back.pose!.up.toArray()).toEqual([0, 0, 1]);
    expect(back.pose!.fov).toBe(39.6);
  });

  it('says little of what is as always', () => {
    expect(formatAddress(shown)).toBe('#eye=1,2.5,-3&target=0,1,0&fov=39.6&exposure=0');
  });

  it.each([[1e4, 3], [2, 1e-5], [0, 1e-9], [5e6, 40]])('keeps poses %d m from the origin that look %d m far', (away, apart) => {
    const eye = new Vector3(away, -0.37 * away, 0.71 * away), target = eye.clone().add(new Vector3(0.6, 0, -0.8).multiplyScalar(apart));
    const back = parseAddress(formatAddress({ ...shown, pose: { ...pose, eye, target } })).pose!;
    expect(back.eye.distanceTo(eye)).toBeLessThan(2e-5 * apart);
    expect(back.target.distanceTo(target)).toBeLessThan(2e-5 * apart);
  });

  it('understands a camera by its name', () => {
    expect(parseAddress('#camera=left%20door').camera).toBe('left door');
  });

  it.each([
    '', '#', '#%', '#eye=1,2&target=0,0,0', '#eye=0,0,0&target=0,0,0', '#eye=a,b,c&target=1,2,3', '#node=-1', '#node=1.5',
    '#node=', '#exposure=bright', '#exposure=1e9', '#curve=none', '#degree=65', '#degree=3.2', '#show=beauty', '#wireframe=2',
    '#camera=%E0%A4%A', '#=&&==&eye', '#eye=1,2,Infinity&target=0,0,0', '#compare=NaN',
  ])('leaves garbage out: %s', (hash) => {
    expect(parseAddress(hash)).toEqual({ settings: {} });
  });

  it('keeps what is good beside garbage', () => {
    const { settings, node, show } = parseAddress('#exposure=x&node=5&curve=reinhard&show=degree&low=9&high=1');
    expect(settings).toEqual({ curve: 'reinhard' });
    expect(node).toBe(5);
    expect(show).toEqual({ quantity: 'degree' });
  });
});
