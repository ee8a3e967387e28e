/**
 * The two bases of a lobe. H, the even hemisphere harmonics, is what files hold; Z, Zernike's polynomials of the
 * unit disc, is H made orthonormal under the cosine, degree by degree: over the hemisphere cos θ dω is the disc's
 * area (docs/conventions.md#projection). So over Z flux is the first coefficient alone, and lowering the degree
 * while keeping the flux is leaving out the rest. Everything the viewer draws and says is over Z.
 *
 * Both have the index k = n (n + 1) / 2 + (n + m) / 2, m = -n, -n + 2, … n; the sine belongs to negative m.
 */
import type { Vec3 } from './frame';

/** How many coefficients degrees 0..lMax have, and where those of the next begin. */
export function coefficientCount(lMax: number): number {
  return ((lMax + 1) * (lMax + 2)) / 2;
}

export function coefficientIndex(n: number, m: number): number {
  return (n * (n + 1)) / 2 + (n + m) / 2;
}

/** One step R_{m+2(j+1)} = (a u + b) R_{m+2j} - c R_{m+2(j-1)}, u = 2 ρ² - 1, of the radial parts before they
 *  are scaled: the recurrence of the Jacobi polynomials P^(0,m) (DLMF 18.9.2). */
export function zernikeStep(m: number, j: number): { a: number; b: number; c: number } {
  const s = 2 * j + m;
  const d = 2 * (j + 1) * (j + 1 + m);
  if (j === 0) return { a: (m + 2) / 2, b: -m / 2, c: 0 };
  return {
    a: ((s + 1) * (s + 2)) / d,
    b: (-m * m * (s + 1)) / (d * s),
    c: (2 * j * (j + m) * (s + 2)) / (d * s),
  };
}

/** What makes R_n^m(ρ) {cos, sin}(m φ) orthonormal over the disc. */
export function zernikeScale(n: number, m: number): number {
  return Math.sqrt(((n + 1) * (m === 0 ? 1 : 2)) / Math.PI);
}

/** R_n^m(ρ), scaled, for n = m, m + 2, … ≤ nMax. */
export function zernikeRadial(m: number, nMax: number, rho: number): number[] {
  const u = 2 * rho * rho - 1;
  const out: number[] = [];
  let before = 0, here = Math.pow(rho, m);
  for (let n = m, j = 0; n <= nMax; n += 2, ++j) {
    out.push(here * zernikeScale(n, m));
    const { a, b, c } = zernikeStep(m, j);
    [before, here] = [here, (a * u + b) * here - c * before];
  }
  return out;
}

/** All Z of degree ≤ lMax towards the local direction (x, y, z), z ≥ 0. */
export function zernikeBasis(lMax: number, [x, y]: Vec3, out = new Float64Array(coefficientCount(lMax))): Float64Array {
  const u = 2 * (x * x + y * y) - 1;
  // ρ^m cos mφ and ρ^m sin mφ, as powers of x + i y.
  let re = 1, im = 0;
  for (let m = 0; m <= lMax; ++m) {
    let before = 0, here = 1;
    for (let n = m, j = 0; n <= lMax; n += 2, ++j) {
      const scaled = here * zernikeScale(n, m);
      out[coefficientIndex(n, m)] = scaled * re;
      if (m > 0) out[coefficientIndex(n, -m)] = scaled * im;
      const { a, b, c } = zernikeStep(m, j);
      [before, here] = [here, (a * u + b) * here - c * before];
    }
    [re, im] = [re * x - im * y, re * y + im * x];
  }
  return out;
}

/** H_l^m without its azimuth, at cos θ = z: √2 K_lm P_lm(z), times √2 more for m > 0; l = m, m + 2, … ≤ lMax. */
function hemisphereColatitude(m: number, lMax: number, z: number): number[] {
  // Normalised associated Legendre functions without Condon and Shortley's sign, by steps of one in l.
  const sine = Math.sqrt(Math.max(0, 1 - z * z));
  let before = 0, here = Math.sqrt(1 / (4 * Math.PI));
  for (let k = 1; k <= m; ++k) here *= Math.sqrt((2 * k + 1) / (2 * k)) * sine;
  const out: number[] = [];
  const scale = Math.SQRT2 * (m > 0 ? Math.SQRT2 : 1);
  for (let l = m; l <= lMax; ++l) {
    if ((l - m) % 2 === 0) out.push(here * scale);
    const A = Math.sqrt(((2 * l + 1) * (2 * l + 3)) / ((l + 1 - m) * (l + 1 + m)));
    const B = l > m ? Math.sqrt(((2 * l + 3) * (l - m) * (l + m)) / ((2 * l - 1) * (l + 1 - m) * (l + 1 + m))) : 0;
    [before, here] = [here, A * z * here - B * before];
  }
  return out;
}

/** All H of degree ≤ lMax towards the local direction (x, y, z), z ≥ 0 (docs/conventions.md#basis). */
export function hemisphereBasis(lMax: number, [x, y, z]: Vec3): Float64Array {
  const out = new Float64Array(coefficientCount(lMax));
  const phi = Math.atan2(y, x);
  for (let m = 0; m <= lMax; ++m) {
    hemisphereColatitude(m, lMax, z).forEach((value, j) => {
      out[coefficientIndex(m + 2 * j, m)] = value * Math.cos(m * phi);
      if (m > 0) out[coefficientIndex(m + 2 * j, -m)] = value * Math.sin(m * phi);
    });
  }
  return out;
}

/** Nodes and weights of Gauss and Legendre on 0..1, exact to degree 2 n - 1. */
function gaussLegendre(n: number): { u: number; weight: number }[] {
  return Array.from({ length: n }, (_, i) => {
    let x = Math.cos((Math.PI * (i + 0.75)) / (n + 0.5)), slope = 1;
    for (let iteration = 0; iteration < 20; ++iteration) {
      let p = 1, q = 0;
      for (let k = 1; k <= n; ++k) [p, q] = [((2 * k - 1) * x * p - (k - 1) * q) / k, p];
      slope = (n * (x * p - q)) / (x * x - 1);
      const step = p / slope;
      x -= step;
      if (Math.abs(step) < 1e-15) break;
    }
    return { u: (1 + x) / 2, weight: 1 / ((1 - x * x) * slope * slope) };
  });
}

/** blocks[m], row-major and square: coefficient n = m + 2 row over Z is Σ_column block · coefficient l = m + 2 column
 *  over H, the same for m and -m. */
function toZernikeBlocks(lMax: number): { size: number; block: Float64Array }[] {
  // A product of two radial parts is a polynomial of degree ≤ lMax in u = ρ².
  const points = gaussLegendre(Math.floor(lMax / 2) + 1);
  return Array.from({ length: lMax + 1 }, (_, m) => {
    const size = Math.floor((lMax - m) / 2) + 1;
    const block = new Float64Array(size * size);
    for (const { u, weight } of points) {
      const h = hemisphereColatitude(m, lMax, Math.sqrt(1 - u));
      const z = zernikeRadial(m, lMax, Math.sqrt(u));
      // ∫ dA = ½ ∫ du ∫ dφ, and ∫ cos² mφ dφ is π, or 2π for m = 0.
      const measure = 0.5 * weight * (m === 0 ? 2 * Math.PI : Math.PI);
      for (let row = 0; row < size; ++row) {
        for (let column = row; column < size; ++column) block[row * size + column] += measure * z[row] * h[column];
      }
    }
    return { size, block };
  });
}

const blocksOf = new Map<number, ReturnType<typeof toZernikeBlocks>>();

/** Coefficients over H to those over Z, for one channel: `h` and `out` hold coefficientCount(lMax). */
export function toZernike(lMax: number, h: ArrayLike<number>, out: Float32Array | Float64Array): void {
  let blocks = blocksOf.get(lMax);
  if (!blocks) blocksOf.set(lMax, (blocks = toZernikeBlocks(lMax)));
  for (let m = -lMax; m <= lMax; ++m) {
    const order = Math.abs(m);
    const { size, block } = blocks[order];
    for (let row = 0; row < size; ++row) {
      let sum = 0;
      for (let column = row; column < size; ++column) {
        sum += block[row * size + column] * h[coefficientIndex(order + 2 * column, m)];
      }
      out[coefficientIndex(order + 2 * row, m)] = sum;
    }
  }
}

/** The way back, for one channel: coefficients over Z to those over H, as files and `lobe inspect` have them. */
export function toHemisphere(lMax: number, z: ArrayLike<number>, out: Float32Array | Float64Array): void {
  let blocks = blocksOf.get(lMax);
  if (!blocks) blocksOf.set(lMax, (blocks = toZernikeBlocks(lMax)));
  for (let m = -lMax; m <= lMax; ++m) {
    const order = Math.abs(m);
    const { size, block } = blocks[order];
    // Upper triangles: from the highest degree down.
    for (let row = size - 1; row >= 0; --row) {
      let rest = z[coefficientIndex(order + 2 * row, m)];
      for (let column = row + 1; column < size; ++column) {
        rest -= block[row * size + column] * out[coefficientIndex(order + 2 * column, m)];
      }
      out[coefficientIndex(order + 2 * row, m)] = rest / block[row * size + row];
    }
  }
}
