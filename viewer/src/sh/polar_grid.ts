/**
 * Lobes on rings about the normal, cut by spokes. On a ring a lobe is a Fourier series in the azimuth, so n spokes of
 * it cost n (2 lMax + 1) multiplications instead of n (lMax + 1)(lMax + 2) / 2: fast enough to follow a slider.
 */
import { coefficientCount, coefficientIndex, zernikeRadial } from './zernike';

export class PolarGrid {
  /** radial[ring][m][j]: the scaled R_n^m, n = m + 2 j, at the ring's sine. */
  private readonly radial: number[][][];
  private readonly cosines: Float64Array;

  /** `sines`: sin θ of each ring. The spokes, a multiple of 4, are at azimuths 2 π (j + `offset`) / `spokes`. */
  constructor(
    readonly lMax: number, readonly sines: readonly number[], readonly spokes: number, readonly offset: 0 | 0.5 = 0,
  ) {
    this.radial = sines.map((rho) => Array.from({ length: lMax + 1 }, (_, m) => zernikeRadial(m, lMax, rho)));
    // cos m φ_j then sin m φ_j, spoke by spoke.
    const row = 2 * (lMax + 1);
    this.cosines = new Float64Array(spokes * row);
    for (let j = 0; j < spokes; ++j) {
      for (let m = 0; m <= lMax; ++m) {
        const angle = (2 * Math.PI * m * (j + offset)) / spokes;
        this.cosines[j * row + m] = Math.cos(angle);
        this.cosines[j * row + lMax + 1 + m] = Math.sin(angle);
      }
    }
  }

  azimuth(spoke: number): number {
    return (2 * Math.PI * (spoke + this.offset)) / this.spokes;
  }

  /** Values [ring · spokes + spoke] of coefficients over Z of any degree up to lMax. */
  evaluate(z: Float64Array): Float64Array {
    const degree = Math.round((Math.sqrt(8 * z.length + 1) - 3) / 2);
    if (degree > this.lMax || coefficientCount(degree) !== z.length) throw new RangeError('PolarGrid: no such degree');
    const out = new Float64Array(this.sines.length * this.spokes);
    const row = 2 * (this.lMax + 1);
    const even = new Float64Array(degree + 1), odd = new Float64Array(degree + 1);
    this.radial.forEach((radial, ring) => {
      for (let m = 0; m <= degree; ++m) {
        let c = 0, s = 0;
        for (let n = m, j = 0; n <= degree; n += 2, ++j) {
          c += radial[m][j] * z[coefficientIndex(n, m)];
          if (m > 0) s += radial[m][j] * z[coefficientIndex(n, -m)];
        }
        even[m] = c;
        odd[m] = s;
      }
      // By symmetry a quarter of the spokes holds what all need, apart by parity: of the cosine in φ and -φ, of m in φ
      // and φ + π.
      const { spokes, offset, cosines } = this, first = ring * spokes;
      for (let spoke = 0; spoke + offset <= spokes / 4; ++spoke) {
        let c0 = 0, s0 = 0, c1 = 0, s1 = 0;
        for (let m = 0, cos = spoke * row, sin = cos + this.lMax + 1; m <= degree; m += 2) {
          c0 += even[m] * cosines[cos + m];
          s0 += odd[m] * cosines[sin + m];
          if (m === degree) break;
          c1 += even[m + 1] * cosines[cos + m + 1];
          s1 += odd[m + 1] * cosines[sin + m + 1];
        }
        const back = spokes - spoke - 2 * offset, half = spokes / 2;
        out[first + spoke] = c0 + c1 + s0 + s1;
        out[first + (spoke + half)] = c0 - c1 + s0 - s1;
        out[first + (back % spokes)] = c0 + c1 - s0 - s1;
        out[first + ((back + half) % spokes)] = c0 - c1 - s0 + s1;
      }
    });
    return out;
  }
}
