import { readFileSync } from 'node:fs';
import { describe, expect, it } from 'vitest';
import { coefficientCount, hemisphereBasis, zernikeBasis } from '../src/sh/zernike';
import type { Vec3 } from '../src/sh/frame';
import { findNode, type Lobes } from '../src/solution/solution';
import { open, openResponse } from './support/open';
import figures from './fixtures/figures.json';
import { coefficients, kFloorDegrees, room } from './support/room';

const directions: Vec3[] = [[0.36, 0.48, 0.8], [-0.6, 0.64, 0.48], [0.28, -0.96, 0], [-0.36, -0.48, 0.8]];

/** Radiance of one channel, from the file's own coefficients. */
function overH(h: Float32Array, lMax: number, row: number, direction: Vec3): number {
  const K = coefficientCount(lMax);
  return hemisphereBasis(lMax, direction).reduce((sum, value, k) => sum + value * h[row * K + k], 0);
}

function overZ({ lMax, z }: Lobes, row: number, direction: Vec3): number {
  const K = coefficientCount(lMax);
  return zernikeBasis(lMax, direction).reduce((sum, value, k) => sum + value * z[row * K + k], 0);
}

describe('A solution', () => {
  it('adds base and gloss of different degrees', async () => {
    const { lobes } = (await open(room().bytes())).patches[0];
    const { lMaxBase, lMaxGloss } = kFloorDegrees;
    expect(lobes!.lMax).toBe(lMaxGloss);
    const base = coefficients(0, 'base', lMaxBase, 4), gloss = coefficients(0, 'gloss', lMaxGloss, 4);
    for (let row = 0; row < 12; ++row) {
      for (const d of directions) {
        expect(overZ(lobes!, row, d)).toBeCloseTo(overH(base, lMaxBase, row, d) + overH(gloss, lMaxGloss, row, d), 5);
      }
    }
  });

  it('has its patches in order, and counts nodes and elements across them', async () => {
    const solution = await open(room().bytes());
    expect(solution.patches.map((p) => p.index)).toEqual([0, 1, 2]);
    expect(solution.patches.map((p) => p.firstNode)).toEqual([0, 4, 7]);
    expect(solution.patches.map((p) => p.side)).toEqual(['front', 'back', 'front']);
    expect(solution.patches.map((p) => solution.surfaceNames[p.surface])).toEqual(['floor', 'wall', 'lamp']);
    expect(solution.nodeCount).toBe(10);
    expect(solution.elementCount).toBe(4);
    expect(findNode(solution, 5)).toEqual({ patch: solution.patches[1], local: 1 });
    expect(findNode(solution, 10)).toBeNull();
    expect(findNode(solution, -1)).toBeNull();
  });

  it('knows places, normals and elements as they were written', async () => {
    const [floor] = (await open(room().bytes())).patches;
    expect(Array.from(floor.positions)).toEqual([0, 0, 0, 0, 0, 1, 1, 0, 1, 1, 0, 0]);
    expect(Array.from(floor.normals.subarray(9))).toEqual([0, 1, 0]);
    expect(Array.from(floor.indices)).toEqual([0, 1, 2, 0, 2, 3]);
    expect(floor.planar).toBe(true);
  });

  it('knows hidden nodes, and patches that reflect nothing', async () => {
    const [floor, wall, lamp] = (await open(room().bytes())).patches;
    expect(floor.hidden).toBeNull();
    expect(Array.from(wall.hidden!)).toEqual([0, 1, 0]);
    expect(wall.planar).toBe(false);
    expect(lamp.lobes).toBeNull();
  });

  it('has the cameras of the file', async () => {
    const { cameras } = await open(room().bytes());
    expect(cameras).toHaveLength(1);
    expect(cameras[0]).toMatchObject({ name: 'view0', fovY: 0.75 });
    expect(cameras[0].matrix.elements.slice(12, 15)).toEqual([0.5, 0.25, 3]);
  });

  it('has the faces of the scene', async () => {
    const { faces } = await open(room().bytes());
    expect(Array.from(faces!.indices)).toEqual([0, 1, 2, 0, 2, 3]);
    expect(Array.from(faces!.material)).toEqual([1, 1]);
    expect(faces!.positions).toHaveLength(12);
    expect(faces!.normals).toHaveLength(12);
  });

  it('has title and exposure', async () => {
    expect(await open(room().bytes())).toMatchObject({ title: 'room.glb', exposureScale: 2 });
  });

  it.each([1, 0.125, 1024])('reads half floats times %d, and does without faces', async (halfScale) => {
    const halves = await open(room({ halfScale }).bytes()), floats = await open(room().bytes());
    expect(halves.faces).toBeNull();
    halves.patches.forEach(({ lobes }, p) => {
      const expected = floats.patches[p].lobes;
      expect(lobes?.lMax).toBe(expected?.lMax);
      // A half has eleven bits, a sum of a few coefficients near 1 loses a little more.
      lobes?.z.forEach((value, i) => expect(Math.abs(value - expected!.z[i])).toBeLessThan(4e-3));
    });
  });

  it('reads lobes that lie interleaved with other values', async () => {
    const glb = room(), plain = await open(glb.bytes());
    const { NORMAL } = glb.json.meshes[1].primitives[0].attributes;
    const spread = new Float32Array(24).fill(9);
    for (let i = 0; i < 4; ++i) spread.set([0, 1, 0], 6 * i + 3);
    const index = glb.accessor(spread);
    glb.json.bufferViews[index].byteStride = 24;
    glb.json.accessors[index] = { ...glb.json.accessors[NORMAL], bufferView: index, byteOffset: 12 };
    glb.json.meshes[1].primitives[0].attributes.NORMAL = index;
    expect((await open(glb.bytes())).patches[0].normals).toEqual(plain.patches[0].normals);
  });

  it('may be gzipped, whatever its name says', async () => {
    const packed = new Response(room().bytes()).body!.pipeThrough(new CompressionStream('gzip'));
    expect((await open(await new Response(packed).arrayBuffer())).nodeCount).toBe(10);
  });

  it('tells how much of it is here', async () => {
    const shares: (number | undefined)[] = [], bytes = room().bytes();
    const known = { headers: { 'Content-Length': String(bytes.byteLength) } };
    await openResponse(() => new Response(bytes, known), (share) => shares.push(share));
    expect(shares.at(-1)).toBe(1);
    await openResponse(() => new Response(bytes), (share) => shares.push(share));
    expect(shares.at(-1)).toBeUndefined();
  });
});

// Written by `lobe solve` of tests/scenes/cornell_glossy.glb with --edge 9 --links 64 --light-samples 16 --lmax 3
// --refine-error 0 --contact-distance 0; figures.json holds what `lobe inspect --json` says of it.
describe('A solution written by lobe solve', () => {
  it('has at each node the light that lobe inspect finds there', async () => {
    const solution = await open(readFileSync(new URL('fixtures/cornell.glb', import.meta.url)).slice().buffer);
    expect(solution.nodeCount).toBe(80);
    expect(figures.length).toBeGreaterThan(5);
    for (const { node, flux, position, material, hidden, peak } of figures) {
      const { patch, local } = findNode(solution, node)!;
      expect(solution.materials[patch.material].name).toBe(material);
      expect(patch.hidden?.[local] === 1).toBe(hidden);
      const lobes = patch.lobes!, K = coefficientCount(lobes.lMax);
      for (let c = 0; c < 3; ++c) {
        expect(patch.positions[3 * local + c]).toBeCloseTo(position[c], 5);
        expect(lobes.z[(3 * local + c) * K] * Math.sqrt(Math.PI)).toBeCloseTo(flux[c], 5);
        expect(overZ(lobes, 3 * local + c, peak.direction_local as unknown as Vec3)).toBeCloseTo(peak.radiance[c], 4);
      }
    }
  });
});
