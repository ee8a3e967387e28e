import { Ray, Vector3 } from 'three';
import { beforeAll, describe, expect, it } from 'vitest';
import type { Solution } from '../src/solution/solution';
import { pickAlong } from '../src/stage/pick';
import { open } from './support/open';
import { room } from './support/room';

// The room: floor (nodes 0 to 3) over 0..1 × 0..1 in x and z, wall at z = 0 (nodes 4, 5, 6; 5, at x = 1, is hidden).
let solution: Solution;
beforeAll(async () => {
  solution = await open(room().bytes());
});

const along = (from: [number, number, number], to: [number, number, number]) => {
  const origin = new Vector3(...from);
  return pickAlong(solution, new Ray(origin, new Vector3(...to).sub(origin).normalize()));
};

describe('A ray', () => {
  it('picks the node that weighs most where it meets an element', () => {
    const pick = along([0.5, 2, 2], [0.75, 0, 0.125])!;
    expect(pick.patch.index).toBe(0);
    expect(pick.element).toBe(1);
    expect(pick.nodes).toEqual([0, 2, 3]);
    [0.25, 0.125, 0.625].forEach((w, k) => expect(pick.weights[k]).toBeCloseTo(w, 10));
    expect(pick.node).toBe(3);
    expect(pick.position.distanceTo(new Vector3(0.75, 0, 0.125))).toBeLessThan(1e-10);
    expect(pick.distance).toBeCloseTo(Math.hypot(0.25, 2, 1.875), 10);
  });

  it('gives hidden nodes no weight, and renormalises the others', () => {
    const pick = along([0.5, 0.5, 2], [0.5, 0.375, 0])!;
    expect(pick.patch.index).toBe(1);
    expect(pick.nodes).toEqual([4, 5, 6]);
    // 1/8, 1/2 and 3/8 without the hidden one.
    [0.25, 0, 0.75].forEach((w, k) => expect(pick.weights[k]).toBeCloseTo(w, 10));
    expect(pick.node).toBe(6);
  });

  it('picks a node even where all are hidden', () => {
    const [floor, wall, lamp] = solution.patches;
    const dark = { ...solution, patches: [floor, { ...wall, hidden: Uint8Array.of(1, 1, 1) }, lamp] };
    const pick = pickAlong(dark, new Ray(new Vector3(0.6, 0.2, 2), new Vector3(0, 0, -1)))!;
    expect(pick.node).toBe(5);
  });

  it('meets the nearest element, on its own side alone', () => {
    expect(along([0.25, 0.25, 2], [0.25, 0.25, -2])!.patch.index).toBe(1);
    expect(along([0.25, 0.25, -2], [0.25, 0.25, 2])).toBeNull();
    expect(along([0.5, -1, 0.5], [0.5, -0.5, 0.5])?.patch.index ?? 2).toBe(2);
    expect(along([0.5, 2, 3], [0.5, 3, 9])).toBeNull();
  });
});
