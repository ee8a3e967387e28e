/** One lobe, over Zernike's basis (sh/zernike.ts): what is done with it before anything is drawn or said. */
import { coefficientCount, zernikeBasis } from '../sh/zernike';
import type { Vec3 } from '../sh/frame';
import { luminance } from '../solution/luminance';
import type { Patch, Rgb } from '../solution/solution';

export interface Lobe {
  lMax: number;
  /** Per channel (red, green, blue), coefficientCount(lMax) of them; W m⁻² sr⁻¹, the node's frame. */
  channels: readonly [Float64Array, Float64Array, Float64Array];
}

/** The lobe of a patch's node; null if the patch is black. */
export function lobeOfNode(patch: Patch, local: number): Lobe | null {
  if (!patch.lobes) return null;
  const { lMax, z } = patch.lobes, K = coefficientCount(lMax);
  const channel = (c: number) => Float64Array.from(z.subarray((3 * local + c) * K, (3 * local + c + 1) * K));
  return { lMax, channels: [channel(0), channel(1), channel(2)] };
}

/** The nearest lobe of a lower degree under the cosine: over Z that is leaving out the rest, so flux stays. */
export function cutLobe(lobe: Lobe, degree: number): Lobe {
  if (degree >= lobe.lMax) return lobe;
  const K = coefficientCount(degree);
  const [r, g, b] = lobe.channels;
  return { lMax: degree, channels: [r.subarray(0, K), g.subarray(0, K), b.subarray(0, K)] };
}

/** Coefficients of luminance. */
export function luminanceOf(lobe: Lobe): Float64Array {
  const [r, g, b] = lobe.channels;
  return Float64Array.from(r, (_, k) => luminance([r[k], g[k], b[k]]));
}

/** Reads coefficients of one channel, or of luminance, towards local directions one by one. */
export class LobeReader {
  private readonly basis: Float64Array<ArrayBuffer>;
  constructor(private readonly lMax: number, private readonly z: Float64Array) {
    this.basis = new Float64Array(coefficientCount(lMax));
  }

  at(w: Vec3): number {
    zernikeBasis(this.lMax, w, this.basis);
    let sum = 0;
    for (let k = 0; k < this.z.length; ++k) sum += this.basis[k] * this.z[k];
    return sum;
  }
}

/** Radiance towards a local direction. */
export function radianceTowards(lobe: Lobe, w: Vec3): Rgb {
  const basis = zernikeBasis(lobe.lMax, w);
  return lobe.channels.map((z) => z.reduce((sum, value, k) => sum + value * basis[k], 0)) as Rgb;
}
