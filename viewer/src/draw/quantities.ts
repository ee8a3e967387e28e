/** What nodes can be coloured by (Settings.falseColour): one number a node of the whole solution. */
import { negativePart } from '../sh/negative_part';
import { coefficientCount } from '../sh/zernike';
import { luminance } from '../solution/luminance';
import type { Lobes, Patch, Solution } from '../solution/solution';
import { areaOf } from '../solution/triangles';
import type { Quantity } from './settings';
import { categories } from './colour_map';

/** Why a quantity cannot be shown, in one sentence; null: it can. */
export function whyNot(solution: Solution, quantity: Quantity): string | null {
  if (quantity === 'irradiance' && !solution.patches.some((p) => solution.materials[p.material].albedo)) {
    return 'The file does not hold its materials’ albedos, without which irradiance cannot be told from reflected light.';
  }
  if (quantity === 'negative' && !solution.patches.some((p) => (p.lobes?.lMax ?? 0) > 0)) {
    return 'All surfaces are diffuse, and diffuse light has no negative part.';
  }
  return null;
}

/** Watts a square metre that leave node `i`, of one channel: the flux is a lobe's first coefficient alone. */
export function exitance(lobes: Lobes, i: number, channel: number): number {
  return lobes.z[(3 * i + channel) * coefficientCount(lobes.lMax)] * Math.sqrt(Math.PI);
}

/** One number a node, in the quantity's unit: radiance W m⁻² sr⁻¹ (of the mean over the hemisphere, emission
 *  included), irradiance W m⁻² (luminance of both), density m⁻², degree, negative flux over flux (of whole lobes), place in
 *  `categories`. What is unknown is 0. */
export function valuesOf(solution: Solution, quantity: Quantity): Float32Array {
  const out = new Float32Array(solution.nodeCount);
  for (const patch of solution.patches) {
    const node = nodeValues(solution, patch, quantity);
    const count = patch.positions.length / 3;
    for (let i = 0; i < count; ++i) out[patch.firstNode + i] = node(i);
  }
  return out;
}

function nodeValues(solution: Solution, patch: Patch, quantity: Quantity): (i: number) => number {
  const material = solution.materials[patch.material];
  const lobes = patch.lobes;
  switch (quantity) {
    case 'radiance': {
      const emits = patch.side === 'front' || material.doubleSided;
      const emitted = emits ? luminance(material.emission) : 0;
      return (i) => emitted + (lobes ? luminance([0, 1, 2].map((c) => exitance(lobes, i, c))) / Math.PI : 0);
    }
    case 'irradiance': {
      const { albedo } = material;
      if (!albedo || !lobes) return () => 0;
      return (i) => luminance(albedo.map((a, c) => (a > 0 ? exitance(lobes, i, c) / a : 0)));
    }
    case 'density': {
      const areas = nodeAreas(patch);
      return (i) => (areas[i] > 0 ? 1 / areas[i] : 0);
    }
    case 'degree':
      return () => lobes?.lMax ?? 0;
    case 'negative': {
      if (!lobes || lobes.lMax === 0) return () => 0;
      const K = coefficientCount(lobes.lMax), z = new Float64Array(K);
      return (i) => {
        for (let k = 0; k < K; ++k) z[k] = luminance([0, 1, 2].map((c) => lobes.z[(3 * i + c) * K + k]));
        return negativePart(lobes.lMax, z);
      };
    }
    case 'hidden':
      return (i) => patch.hidden?.[i] ?? 0;
    case 'kind': {
      const kind = categories.kind.findIndex((k) => k.name === material.kind);
      return () => kind;
    }
  }
}

/** Each element's area, shared among its corners: square metres. */
function nodeAreas(patch: Patch): Float64Array {
  const out = new Float64Array(patch.positions.length / 3);
  patch.indices.forEach((node, i) => (out[node] += areaOf(patch, Math.floor(i / 3)) / 3));
  return out;
}

/** From the 2nd to the 98th percentile of what the nodes have: a scale that outliers do not stretch. */
export function percentiles(values: Float32Array): { low: number; high: number } {
  const sorted = Float32Array.from(values).sort();
  if (sorted.length === 0) return { low: 0, high: 1 };
  const at = (share: number) => sorted[Math.round(share * (sorted.length - 1))];
  const low = at(0.02), high = at(0.98);
  if (high > low) return { low, high };
  // Nearly all alike: all there is, or around it.
  const all = { low: sorted[0], high: sorted[sorted.length - 1] };
  return all.high > all.low ? all : { low: Math.min(0, low), high: low > 0 ? 2 * low : 1 };
}
