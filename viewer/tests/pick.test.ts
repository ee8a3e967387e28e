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

  it('ends at what is black, unless that is a back one looks through', () => {
    // The wall faces +z, as does what stands before it: its front is black.
    const [, wall] = solution.patches, ray = new Ray(new Vector3(0.25, 0.25, 2), new Vector3(0, 0, -1));
    const faceAt = (z: number, flipped = false, material = 0): Solution => ({
      ...solution, faces: {
        positions: Float32Array.from([0, 0, z, 1, 0, z, 0, 1, z]), normals: new Float32Array(9),
        indices: Uint32Array.from(flipped ? [0, 2, 1] : [0, 1, 2]), material: [material],
      },
    });
    for (const through of [false, true]) {
      expect(pickAlong(faceAt(0.5), ray, through)).toBeNull();
      // In it, behind it, behind the eye.
      for (const z of [0, 1e-6, -0.5, 3]) expect(pickAlong(faceAt(z), ray, through)!.patch).toBe(wall);
    }
    expect(pickAlong(faceAt(0.5, true), ray)).toBeNull();
    expect(pickAlong(faceAt(0.5, true), ray, true)!.patch).toBe(wall);
    const glass = faceAt(0.5);
    glass.materials = solution.materials.map((m) => ({ ...m, transmission: [1, 1, 1] as [number, number, number] }));
    expect(pickAlong(glass, ray)!.patch).toBe(wall);
  });

  it('ends at the backs of elements where there are no faces', () => {
    const [floor] = solution.patches, ray = new Ray(new Vector3(0.25, 2, 0.25), new Vector3(0, -1, 0));
    const lidded: Solution = { ...solution, faces: null };  // the lamp, above, looks down
    expect(pickAlong({ ...solution, faces: null, patches: [floor] }, ray)!.patch).toBe(floor);
    const from = new Ray(new Vector3(0.2, 2, 0.6), new Vector3(0, -1, 0));
    expect(pickAlong(lidded, from, true)?.patch.index).toBe(0);
    expect(pickAlong(lidded, from)).toBeNull();
  });

  it('is quick among many elements', () => {
    const n = 200, positions = new Float32Array(3 * (n + 1) ** 2), indices = new Uint32Array(6 * n * n);
    for (let i = 0, v = 0; i <= n; ++i) for (let k = 0; k <= n; ++k) positions.set([i / n, 0, k / n], 3 * v++);
    for (let i = 0, at = 0; i < n; ++i) {
      for (let k = 0; k < n; ++k, at += 6) {
        const v = i * (n + 1) + k;
        indices.set([v, v + 1, v + n + 2, v, v + n + 2, v + n + 1], at);
      }
    }
    const [floor] = solution.patches, large = { ...solution, patches: [{ ...floor, positions, indices, hidden: null }] };
    const rays = Array.from({ length: 100 }, (_, i) => {
      const target = new Vector3((i + 0.31) / 100, 0, (((37 * i) % 100) + 0.77) / 100), origin = new Vector3(0.5, 2, 0.4);
      return { target, ray: new Ray(origin, target.clone().sub(origin).normalize()) };
    });
    pickAlong(large, rays[0].ray);
    const start = performance.now();
    for (const { target, ray } of rays) expect(pickAlong(large, ray)!.position.distanceTo(target)).toBeLessThan(1e-6);
    // Measured: 0.2 ms, and 2.5 ms if every element is looked at.
    expect((performance.now() - start) / rays.length).toBeLessThan(1);
  });
});
