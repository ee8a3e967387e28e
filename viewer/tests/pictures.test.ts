import { describe, expect, it } from 'vitest';
import { toneMap } from '../src/draw/tone_curves';
import type { Lobe } from '../src/inspect/lobe';
import { sliceOf } from '../src/inspect/slices';
import { paperTheme, roundUp, slicesSvg } from '../src/inspect/slices_svg';
import { spectrumSvg } from '../src/inspect/spectrum_svg';
import { surfaceOf } from '../src/inspect/surface';
import { toZernike } from '../src/sh/zernike';

/** L = a + b x. */
function linear(a: number, b: number): Lobe {
  const z = new Float64Array(3);
  toZernike(1, [a * Math.sqrt(2 * Math.PI), 0, b * Math.sqrt((2 * Math.PI) / 3)], z);
  return { lMax: 1, channels: [z, z, z] };
}

describe('The surface of a lobe', () => {
  it('is as far from the node as radiance is great', () => {
    const { positions, luminance } = surfaceOf(linear(0.5, 1));
    for (let i = 0; i < luminance.length; ++i) {
      const [x, y, z] = positions.subarray(3 * i, 3 * i + 3), r = Math.hypot(x, y, z);
      expect(r).toBeCloseTo(Math.abs(luminance[i]), 6);
      if (r > 0.01) expect(0.5 + x / r).toBeCloseTo(luminance[i], 5);
    }
  });

  it('has one mesh for all cuts of a lobe', () => {
    expect(surfaceOf(linear(1, 1), 12).triangles).toBe(surfaceOf(linear(1, 0), 12).triangles);
    const { triangles, lines, luminance } = surfaceOf(linear(1, 1), 12);
    for (const index of [...triangles, ...lines]) expect(index).toBeLessThan(luminance.length);
  });
});

describe('Slices as SVG', () => {
  const curves = (a: number, b: number, phi: number) => [{ slice: sliceOf(linear(a, b), phi), colour: 0 }];
  const svg = (a: number, b: number, title = 'node 7') =>
    slicesSvg(curves(a, b, 0), curves(a, b, 90), { theme: paperTheme, width: 640, title });

  it('mark what is negative, and only that', () => {
    expect(svg(1, 0.5)).not.toContain(paperTheme.negative);
    expect(svg(1, 2)).toContain(paperTheme.negative);
  });

  it('keep names from being markup', () => {
    expect(svg(1, 0, '<wall> & "floor"')).toContain('&lt;wall> &amp; &quot;floor&quot;');
  });

  it('hold numbers alone, for a black lobe too', () => {
    for (const text of [svg(0, 0), svg(1, 3)]) expect(text).not.toMatch(/NaN|Infinity|undefined/);
  });

  it.each([[0.93, 1], [1, 1], [1.2, 2], [2.2, 2.5], [0.031, 0.05], [0, 1]])('round %f up to %f', (value, up) => {
    expect(roundUp(value)).toBeCloseTo(up, 12);
  });
});

describe('The spectrum as SVG', () => {
  it('has a bar for every degree within six decades, faint beyond the cut', () => {
    const text = spectrumSvg([{ energy: [1, 0.1, 1e-9], colour: 0 }], 0, paperTheme, 300);
    expect(text.match(/<rect/g)).toHaveLength(2);
    expect(text.match(/fill-opacity="0.22"/g)).toHaveLength(1);
  });
});

describe('Tone', () => {
  // render/tone.cpp's white points, and 0 for nothing.
  it.each([['srgb', 1], ['reinhard', 4], ['filmic', 5.6]] as const)('of %s reaches 1 at %f', (curve, white) => {
    expect(toneMap(curve, white)).toBeCloseTo(1, 12);
    expect(toneMap(curve, 0.5 * white)).toBeLessThan(1);
    expect(toneMap(curve, -1)).toBe(0);
  });
});
