import { DataUtils, PerspectiveCamera, Plane, Vector3 } from 'three';
import { describe, expect, it } from 'vitest';
import { categories, colourAt } from '../src/draw/colour_map';
import { halfScale, toHalves } from '../src/draw/half';
import { bySlot, edgesOf, elementsOf, layOut } from '../src/draw/layout';
import { checkRoom } from '../src/draw/lobe_textures';
import { exitance, percentiles, valuesOf, whyNot } from '../src/draw/quantities';
import { MirroredCamera, reflectionIn } from '../src/draw/reflection';
import { glassOf, mirrorsOf } from '../src/draw/specular_parts';
import { inspectNode } from '../src/inspect/inspection';
import { coefficientCount } from '../src/sh/zernike';
import { luminance } from '../src/solution/luminance';
import { Problem } from '../src/solution/problem';
import type { Material, Patch, Solution } from '../src/solution/solution';

const material = (change: Partial<Material> = {}): Material => ({
  name: 'm', kind: 'none', error: 0, emission: [0, 0, 0], doubleSided: false, albedo: [0.5, 0.5, 0.5],
  specular: { f0: [0, 0, 0], f90: [1, 1, 1] }, transmission: null, extinction: [0, 0, 0], ...change,
});

/** A unit square in two elements at height y, facing up. `z` of a channel, the same for all nodes and channels. */
function square(y: number, lMax: number, z: number[], change: Partial<Patch> = {}): Patch {
  const K = coefficientCount(lMax);
  const lobe = Array.from({ length: K }, (_, k) => z[k] ?? 0);
  return {
    index: 0, material: 0, surface: 0, side: 'front', planar: true, firstNode: 0,
    positions: Float32Array.from([0, y, 0, 0, y, 1, 1, y, 1, 1, y, 0]),
    normals: Float32Array.from([0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0]),
    indices: Uint32Array.from([0, 1, 2, 0, 2, 3]), hidden: null,
    lobes: { lMax, z: Float32Array.from([...Array(12)].flatMap(() => lobe)) }, ...change,
  };
}

function solutionOf(patches: Patch[], materials = [material()]): Solution {
  let nodeCount = 0;
  patches.forEach((p, index) => {
    Object.assign(p, { index, firstNode: nodeCount });
    nodeCount += p.positions.length / 3;
  });
  return {
    title: 'test', materials, surfaceNames: ['s'], patches, faces: null, cameras: [], nodeCount,
    elementCount: 2 * patches.length, exposureScale: 1, trust: '',
  };
}

describe('Halves', () => {
  it('are the nearest ones, large and small', () => {
    const values = Float32Array.from({ length: 2000 }, (_, i) => (i % 2 ? -1 : 1) * 1.17 ** (i % 60) * (1e-7 + i * 1.3e-6));
    const halves = new Uint16Array(values.length);
    toHalves(values, 1, halves);
    values.forEach((v, i) => {
      // Half of the distance to the neighbour: 2^-11 of the number, or 2^-25 where they are denormal.
      expect(Math.abs(DataUtils.fromHalfFloat(halves[i]) - v)).toBeLessThanOrEqual(Math.max(Math.abs(v) * 2 ** -11, 2 ** -25));
    });
  });

  it('end at 65504 instead of infinity', () => {
    const out = new Uint16Array(2);
    toHalves(Float32Array.from([1e9, -1e9]), 1, out);
    expect([...out].map((h) => DataUtils.fromHalfFloat(h))).toEqual([65504, -65504]);
  });

  it('are scaled to their upper range by a power of two', () => {
    for (const largest of [3e-7, 0.9, 1, 5000, 1e8]) {
      const scale = halfScale(largest);
      expect(Number.isInteger(Math.log2(scale))).toBe(true);
      expect(largest * scale).toBeGreaterThan(2 ** 13 * 0.999);
      expect(largest * scale).toBeLessThanOrEqual(2 ** 14);
    }
  });
});

describe('Layout', () => {
  const solution = solutionOf([square(0, 4, [1]), square(1, 0, [1]), square(2, 2, [1]), square(3, 0, [], { lobes: null })]);
  const layout = layOut(solution);

  it('puts flat nodes first, and their slots are their coefficients', () => {
    expect(layout.flatCount).toBe(8);
    for (const p of layout.patches.filter((p) => p.firstSlot < 8)) expect(p.firstCoefficient).toBe(p.firstSlot);
    expect(layout.coefficientCount).toBe(8 + 4 * 6 + 4 * 15);
  });

  it('carries numbers of nodes along', () => {
    const moved = bySlot(layout, Float32Array.from({ length: 16 }, (_, i) => i));
    for (const { patch, firstSlot } of layout.patches) expect(moved[firstSlot + 2]).toBe(patch.firstNode + 2);
  });

  it('has to have room in textures', () => {
    const glossy = (count: number) => ({ ...layout, nodeCount: count + 8, coefficientCount: 8 + 3 * count });
    expect(() => checkRoom(glossy(4e6), { side: 4096, layers: 256 })).not.toThrow();
    expect(() => checkRoom(glossy(4e6), { side: 2048, layers: 256 })).toThrow(/4000000 glossy nodes/);
    expect(() => checkRoom({ ...layout, coefficientCount: 2 ** 31 }, { side: 4096, layers: 256 })).toThrow(Problem);
  });

  it('has every edge once', () => {
    expect(edgesOf(elementsOf(layout.patches), layout.nodeCount).length).toBe(2 * 5 * 4);
  });
});

describe('Colours', () => {
  it('get lighter all the way', () => {
    let before = -1;
    for (let i = 0; i <= 100; ++i) {
      const here = luminance(colourAt(i / 100).map((v) => v ** 2.2));
      expect(here).toBeGreaterThan(before);
      before = here;
    }
  });

  it('end at the ends of the scale', () => {
    expect(colourAt(-3)).toEqual(colourAt(0));
    expect(colourAt(7)).toEqual(colourAt(1));
    expect(colourAt(NaN)).toEqual(colourAt(0));
  });

  it('tell kinds apart in grey, too', () => {
    const lights = categories.kind.map((k) => luminance(k.colour)).sort();
    for (let i = 1; i < lights.length; ++i) expect(lights[i] - lights[i - 1]).toBeGreaterThan(0.1);
  });
});

describe('Quantities', () => {
  it('are exitance over albedo, for irradiance', () => {
    // Radiance 2 to everywhere: z_0 = 2 √π, exitance 2 π.
    const solution = solutionOf([square(0, 0, [2 * Math.sqrt(Math.PI)])]);
    expect(exitance(solution.patches[0].lobes!, 1, 2)).toBeCloseTo(2 * Math.PI, 5);
    expect(valuesOf(solution, 'irradiance')[3]).toBeCloseTo(4 * Math.PI, 4);
    expect(valuesOf(solution, 'radiance')[0]).toBeCloseTo(2, 5);
  });

  it('say what is missing', () => {
    const solution = solutionOf([square(0, 0, [1])], [material({ albedo: null })]);
    expect(whyNot(solution, 'irradiance')).toMatch(/albedo/);
    expect(valuesOf(solution, 'irradiance')[0]).toBe(0);
    expect(whyNot(solution, 'density')).toBeNull();
  });

  it('count nodes a square metre', () => {
    const values = valuesOf(solutionOf([square(0, 0, [1])]), 'density');
    expect(values.map((v) => 1 / v).reduce((a, b) => a + b)).toBeCloseTo(1, 5);
  });

  it('know the negative flux of a lobe of degree 1', () => {
    // L = x on the disc, in Zernike's Z_1^1 = 2 x / √π; none of it is flux, so a constant is added: L = x + 1/2.
    // Its flux is π/2; what is below zero lies beyond the chord x < -1/2: ∫ (x + 1/2) dA = π/6 - 3 √3 / 8 there.
    const solution = solutionOf([square(0, 1, [Math.sqrt(Math.PI) / 2, 0, Math.sqrt(Math.PI) / 2])]);
    const share = (3 * Math.sqrt(3) / 8 - Math.PI / 6) / (Math.PI / 2);
    // 26 rings of 52 directions see the chord's edge to about a thousandth of the flux.
    expect(Math.abs(valuesOf(solution, 'negative')[0] - share)).toBeLessThan(0.001);
  });

  it('have the negative part that the inspector has, of luminance', () => {
    const solution = solutionOf([square(0, 4, [3, 1, -2, 0.5, 1.5, -1, 0.7, 2, -0.3])]);
    const { lobes } = solution.patches[0], K = coefficientCount(4);
    // Channels that make up for each other.
    for (let k = 1; k < K; ++k) lobes!.z[K + k] *= -2;
    const { negative } = inspectNode(solution, 0, 4)!.figures!;
    expect(negative).toBeGreaterThan(0.01);
    expect(valuesOf(solution, 'negative')[0]).toBeCloseTo(negative, 6);
  });

  it('have a scale that outliers do not stretch', () => {
    const values = Float32Array.from({ length: 1000 }, (_, i) => (i === 7 ? 1e9 : i));
    expect(percentiles(values).high).toBeLessThan(1000);
    expect(percentiles(Float32Array.from([3, 3, 3]))).toEqual({ low: 0, high: 6 });
    expect(percentiles(new Float32Array(0))).toEqual({ low: 0, high: 1 });
  });
});

describe('Mirrors', () => {
  const plane = new Plane(new Vector3(1, 2, -0.5).normalize(), -0.7);

  it('keep what is in them, and take the rest across', () => {
    const p = new Vector3(3, -1, 2), image = p.clone().applyMatrix4(reflectionIn(plane));
    expect(plane.distanceToPoint(image)).toBeCloseTo(-plane.distanceToPoint(p), 10);
    expect(plane.projectPoint(p, new Vector3()).distanceTo(plane.projectPoint(image, new Vector3()))).toBeLessThan(1e-10);
    expect(image.applyMatrix4(reflectionIn(plane)).distanceTo(p)).toBeLessThan(1e-10);
  });

  it('show a thing at the pixel where its image is, flipped', () => {
    const eye = new PerspectiveCamera(50, 1.5, 0.1, 100);
    eye.position.set(4, 3, 1);
    eye.lookAt(0, 0, 0);
    eye.updateMatrixWorld();
    const mirrored = new MirroredCamera();
    mirrored.reflect(eye, plane, 0, () => 100);
    expect(mirrored.matrixWorld.determinant()).toBeCloseTo(1, 6);
    const thing = new Vector3(1.5, 1, 0.3);
    expect(plane.distanceToPoint(thing)).toBeGreaterThan(0);
    const image = thing.clone().applyMatrix4(reflectionIn(plane)).project(eye), seen = thing.clone().project(mirrored);
    expect(seen.x).toBeCloseTo(-image.x, 6);
    expect(seen.y).toBeCloseTo(image.y, 6);
    expect(Math.abs(seen.z)).toBeLessThan(1);
    // What is behind the mirror is before the near plane.
    expect(plane.projectPoint(thing, new Vector3()).addScaledVector(plane.normal, -0.05).project(mirrored).z).toBeLessThan(-1);
  });

  it('in one plane are one part, curved ones are their own', () => {
    const mirror = material({ kind: 'mirror' });
    const solution = solutionOf(
      [square(0, 0, [1]), square(0, 0, [1]), square(1, 0, [1]), square(0, 0, [1], { planar: false })], [mirror]);
    const parts = mirrorsOf(solution, layOut(solution), 1);
    expect(parts.map((p) => p.patches.length)).toEqual([2, 1, 1]);
    expect(parts.map((p) => p.plane !== null)).toEqual([true, true, false]);
    expect(parts[0].area).toBeCloseTo(2, 6);
  });
});

describe('Glass', () => {
  it('is cut into pieces that hang together, flat ones known as such', () => {
    const solution = solutionOf([], [material({ transmission: [1, 1, 1] })]);
    // Two triangles with an edge in common, and a bent pair far away.
    const positions = Float32Array.from([
      0, 0, 0, 1, 0, 0, 1, 0, 1, 0, 0, 1, 5, 0, 0, 6, 0, 0, 6, 0, 1, 5, 1, 1]);
    solution.faces = {
      positions, normals: new Float32Array(positions.length), indices: Uint32Array.from([0, 1, 2, 0, 2, 3, 4, 5, 6, 4, 6, 7]),
      material: [0, 0, 0, 0],
    };
    const parts = glassOf(solution, 6);
    expect(parts.length).toBe(2);
    expect(parts.map((p) => p.plane !== null)).toEqual([true, false]);
    expect(parts.map((p) => p.glass!.positions.length)).toEqual([18, 18]);
  });

  it('is as flat with a triangle that has no area', () => {
    const solution = solutionOf([], [material({ transmission: [1, 1, 1] })]);
    const positions = Float32Array.from([0, 0, 0, 1, 0, 0, 1, 0, 1, 0.5, 0, 0]);
    solution.faces = {
      positions, normals: new Float32Array(12), indices: Uint32Array.from([0, 3, 1, 0, 1, 2]), material: [0, 0],
    };
    expect(glassOf(solution, 6).map((p) => p.plane !== null)).toEqual([true]);
  });

  it('has a volume if it is a body', () => {
    const solution = solutionOf([], [material({ transmission: [1, 1, 1] })]);
    // A tetrahedron with three edges of length 2 at a right angle, far from the origin.
    const positions = Float32Array.from([5, 5, 5, 7, 5, 5, 5, 7, 5, 5, 5, 7]);
    solution.faces = {
      positions, normals: new Float32Array(12), indices: Uint32Array.from([0, 2, 1, 0, 3, 2, 0, 1, 3, 1, 2, 3]),
      material: [0, 0, 0, 0],
    };
    const [part] = glassOf(solution, 6);
    expect(part.volume).toBeCloseTo(8 / 6, 5);
    expect(part.area).toBeCloseTo(6 + 2 * Math.sqrt(3), 5);
  });
});
