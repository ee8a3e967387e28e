/**
 * Where things lie on the GPU. A node's *slot* is its number there: flat nodes first (one coefficient, or none: the same
 * towards every eye), then glossy ones by rising degree, so that neighbours in a wave of shader invocations run loops
 * of one length.
 */
import { coefficientCount } from '../sh/zernike';
import type { Patch, Solution } from '../solution/solution';

export interface PlacedPatch {
  patch: Patch;
  firstSlot: number;
  /** Of the patch's first coefficient in the texture; each node has `coefficientsOfNode`. */
  firstCoefficient: number;
  coefficientsOfNode: number;
}

export interface Layout {
  patches: PlacedPatch[];
  nodeCount: number;
  /** Slots below are flat; coefficient `slot` is all that node has. */
  flatCount: number;
  coefficientCount: number;
}

export function isFlat(patch: Patch): boolean {
  return !patch.lobes || patch.lobes.lMax === 0;
}

export function layOut(solution: Solution): Layout {
  const degree = (p: Patch) => p.lobes?.lMax ?? 0;
  const sorted = [...solution.patches].sort((a, b) => degree(a) - degree(b));
  const layout: Layout = { patches: [], nodeCount: 0, flatCount: 0, coefficientCount: 0 };
  for (const patch of sorted) {
    const nodes = patch.positions.length / 3, coefficientsOfNode = coefficientCount(degree(patch));
    layout.patches.push({
      patch, firstSlot: layout.nodeCount, firstCoefficient: layout.coefficientCount, coefficientsOfNode,
    });
    layout.nodeCount += nodes;
    layout.coefficientCount += nodes * coefficientsOfNode;
    if (isFlat(patch)) layout.flatCount = layout.nodeCount;
  }
  return layout;
}

/** One number a node, in the order of slots. */
export function bySlot(layout: Layout, values: Float32Array): Float32Array {
  const out = new Float32Array(layout.nodeCount);
  for (const { patch, firstSlot } of layout.patches) {
    out.set(values.subarray(patch.firstNode, patch.firstNode + patch.positions.length / 3), firstSlot);
  }
  return out;
}

/** The elements of some patches, as slots. */
export function elementsOf(placed: readonly PlacedPatch[]): Uint32Array {
  const out = new Uint32Array(placed.reduce((n, p) => n + p.patch.indices.length, 0));
  let at = 0;
  for (const { patch, firstSlot } of placed) {
    for (let i = 0; i < patch.indices.length; ++i) out[at++] = patch.indices[i] + firstSlot;
  }
  return out;
}

/** Pairs of slots: every edge once. */
export function edgesOf(elements: Uint32Array, nodeCount: number): Uint32Array {
  const seen = new Set<number>();
  const out: number[] = [];
  for (let i = 0; i < elements.length; i += 3) {
    for (let k = 0; k < 3; ++k) {
      const a = elements[i + k], b = elements[i + ((k + 1) % 3)];
      const key = Math.min(a, b) * nodeCount + Math.max(a, b);
      if (seen.has(key)) continue;
      seen.add(key);
      out.push(a, b);
    }
  }
  return Uint32Array.from(out);
}
