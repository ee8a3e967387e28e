/** What nodes can be coloured by (Settings.falseColour): one number a node of the whole solution. */
import { coefficientCount, zernikeRadial } from '../sh/zernike';
import type { Lobes, Patch, Rgb, Solution } from '../solution/solution';
import type { Quantity } from './settings';
import { categories } from './colour_map';

const kLuminance: Rgb = [0.2126, 0.7152, 0.0722];  // Rec. 709

export function luminance(colour: ArrayLike<number>): number {
  return kLuminance[0] * colour[0] + kLuminance[1] * colour[1] + kLuminance[2] * colour[2];
}

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
 *  included), irradiance W m⁻² (luminance of both), density m⁻², degree, negative flux over flux, place in
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
      const measure = new NegativePart(lobes.lMax);
      return (i) => measure.of(lobes, i);
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
function nodeAreas({ positions: p, indices }: Patch): Float64Array {
  const out = new Float64Array(p.length / 3);
  for (let e = 0; e < indices.length; e += 3) {
    const [a, b, c] = [3 * indices[e], 3 * indices[e + 1], 3 * indices[e + 2]];
    const u = [p[b] - p[a], p[b + 1] - p[a + 1], p[b + 2] - p[a + 2]];
    const v = [p[c] - p[a], p[c + 1] - p[a + 1], p[c + 2] - p[a + 2]];
    const area = 0.5 * Math.hypot(u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]);
    for (let k = 0; k < 3; ++k) out[indices[e + k]] += area / 3;
  }
  return out;
}

/**
 * The flux of what is below zero, over the flux (docs/conventions.md: Error figures of lobes), all channels together:
 * summed over the unit disc, whose area is flux, on rings of equal area. First the radial sums of a ring, then the
 * azimuth: some 20 000 products a channel at degree 20, so 10 000 nodes take about a second, once.
 */
class NegativePart {
  private static readonly kRings = 12;
  /** radial[ring][m]: R_n^m there, n = m, m + 2, … */
  private readonly radial: number[][][] = [];
  private readonly cos: Float64Array[] = [];
  private readonly sin: Float64Array[] = [];
  private readonly directions: number;

  constructor(private readonly lMax: number) {
    this.directions = Math.max(24, 2 * lMax);
    for (let ring = 0; ring < NegativePart.kRings; ++ring) {
      const rho = Math.sqrt((ring + 0.5) / NegativePart.kRings);
      this.radial.push(Array.from({ length: lMax + 1 }, (_, m) => zernikeRadial(m, lMax, rho)));
    }
    for (let d = 0; d < this.directions; ++d) {
      const phi = (2 * Math.PI * (d + 0.5)) / this.directions;
      this.cos.push(Float64Array.from({ length: lMax + 1 }, (_, m) => Math.cos(m * phi)));
      this.sin.push(Float64Array.from({ length: lMax + 1 }, (_, m) => Math.sin(m * phi)));
    }
  }

  of({ z }: Lobes, node: number): number {
    const { lMax } = this, K = coefficientCount(lMax);
    const even = new Float64Array(lMax + 1), odd = new Float64Array(lMax + 1);
    let below = 0, sum = 0;
    for (let c = 0; c < 3; ++c) {
      const first = (3 * node + c) * K;
      for (const radial of this.radial) {
        for (let m = 0; m <= lMax; ++m) {
          even[m] = odd[m] = 0;
          for (let j = 0, n = m; n <= lMax; ++j, n += 2) {
            const k = first + (n * (n + 1)) / 2 + (n + m) / 2;
            even[m] += radial[m][j] * z[k];
            if (m > 0) odd[m] += radial[m][j] * z[k - m];
          }
        }
        for (let d = 0; d < this.directions; ++d) {
          const cos = this.cos[d], sin = this.sin[d];
          let value = even[0];
          for (let m = 1; m <= lMax; ++m) value += even[m] * cos[m] + odd[m] * sin[m];
          sum += value;
          if (value < 0) below -= value;
        }
      }
    }
    return sum > 0 ? below / sum : 0;
  }
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
