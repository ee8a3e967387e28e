import { PerspectiveCamera, Vector3 } from 'three';
import { describe, expect, it } from 'vitest';
import { between, forwardOf, look, orbit, pan, walk, zoom } from '../src/stage/moves';
import type { Pose } from '../src/stage/stage';

const pose: Pose = { eye: new Vector3(3, 2, 4), target: new Vector3(0.5, 1, -1), up: new Vector3(0, 1, 0), fov: 50 };

/** Where a point is on a canvas 2 high, from its middle. */
function onCanvas(p: Pose, point: Vector3): Vector3 {
  const camera = new PerspectiveCamera(p.fov, 1.5, 0.01, 100);
  camera.position.copy(p.eye);
  camera.up.copy(p.up);
  camera.lookAt(p.target);
  camera.updateMatrixWorld();
  return point.clone().project(camera);
}

describe('Moving', () => {
  it('about the target keeps the distance, and stops at the pole', () => {
    const turned = orbit(pose, 0.7, 0.2);
    expect(turned.eye.distanceTo(pose.target)).toBeCloseTo(pose.eye.distanceTo(pose.target), 10);
    const above = orbit(pose, 0, 10);
    expect(above.eye.clone().sub(above.target).angleTo(pose.up)).toBeCloseTo(0.01, 6);
    expect(orbit(above, 0, 1).eye.distanceTo(above.eye)).toBeLessThan(1e-6);
  });

  it('the head keeps the eye, and looks up for positive pitch', () => {
    const turned = look(pose, 0.3, 0.2);
    expect(turned.eye).toEqual(pose.eye);
    expect(forwardOf(turned).y).toBeGreaterThan(forwardOf(pose).y);
  });

  it('towards a place keeps it where it is on the canvas', () => {
    const place = new Vector3(-0.4, 0.8, -2), before = onCanvas(pose, place);
    const after = onCanvas(zoom(pose, place, 0.4, 1e-3), place);
    expect(after.x).toBeCloseTo(before.x, 8);
    expect(after.y).toBeCloseTo(before.y, 8);
  });

  it('towards a place ends before it, and leads back', () => {
    let near = pose;
    for (let i = 0; i < 200; ++i) near = zoom(near, pose.target, 1 / 1.15, 1e-3);
    expect(near.eye.distanceTo(near.target)).toBeCloseTo(1e-3, 9);
    expect(near.target.distanceTo(pose.target)).toBeLessThan(1e-9);
    expect(forwardOf(near).distanceTo(forwardOf(pose))).toBeLessThan(1e-9);
    expect(zoom(near, near.target, 2, 1e-3).eye.distanceTo(near.target)).toBeCloseTo(2e-3, 9);
    // A target that is near already does not hold the eye back from what is farther.
    const place = new Vector3(0, 0, -3);
    expect(zoom(near, place, 0.5, 1e-3).eye.distanceTo(place)).toBeCloseTo(near.eye.distanceTo(place) / 2, 9);
  });

  it('sideways takes what is at the target along with the pointer', () => {
    const after = onCanvas(pan(pose, 30, -20, 600), pose.target);
    expect(after.x * 1.5 * 300).toBeCloseTo(30, 6);
    expect(after.y * 300).toBeCloseTo(20, 6);
  });

  it('on foot stays level', () => {
    const ahead = walk(pose, 0, 0, 2);
    expect(ahead.eye.y).toBe(pose.eye.y);
    expect(ahead.eye.distanceTo(pose.eye)).toBeCloseTo(2, 12);
    expect(ahead.eye.clone().sub(pose.eye).dot(forwardOf(pose))).toBeGreaterThan(0);
    expect(walk(pose, 0, 1.5, 0).eye.y).toBeCloseTo(3.5, 12);
  });

  it('from pose to pose begins at one and ends at the other', () => {
    const other: Pose = { eye: new Vector3(-1, 0, 2), target: new Vector3(4, 0, 2), up: new Vector3(0, 1, 0), fov: 30 };
    expect(between(pose, other, 0).eye.distanceTo(pose.eye)).toBeLessThan(1e-12);
    expect(between(pose, other, 0).target.distanceTo(pose.target)).toBeLessThan(1e-12);
    expect(between(pose, other, 1)).toBe(other);
  });
});
