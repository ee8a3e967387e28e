import { describe, expect, it } from 'vitest';
import { cutLobe, radianceTowards, type Lobe } from '../src/inspect/lobe';
import { errorOfCut, fluxOf, measureLobe, spectrumOf } from '../src/inspect/figures';
import { PolarGrid } from '../src/sh/polar_grid';
import { reachOf, sliceOf } from '../src/inspect/slices';
import { coefficientCount, hemisphereBasis, toHemisphere, toZernike, zernikeBasis } from '../src/sh/zernike';

const grey = (lMax: number, z: Float64Array): Lobe => ({ lMax, channels: [z, z, z] });
const some = (lMax: number, seed: number) =>
  Float64Array.from({ length: coefficientCount(lMax) }, (_, k) => Math.sin(seed * (k + 1)) + (k === 0 ? 3 : 0));

/** L = a + b x: over H, then Z. */
function linear(a: number, b: number): Lobe {
  const z = new Float64Array(3);
  toZernike(1, [a * Math.sqrt(2 * Math.PI), 0, b * Math.sqrt((2 * Math.PI) / 3)], z);
  return grey(1, z);
}

/** The projection of cos^n of the angle to a direction, by sums over a fine disc. */
function phong(lMax: number, exponent: number, thetaDegrees: number, phiDegrees: number): Lobe {
  const theta = (thetaDegrees * Math.PI) / 180, phi = (phiDegrees * Math.PI) / 180;
  const d = [Math.sin(theta) * Math.cos(phi), Math.sin(theta) * Math.sin(phi), Math.cos(theta)];
  const z = new Float64Array(coefficientCount(lMax)), rings = 120, spokes = 240;
  for (let i = 0; i < rings; ++i) {
    for (let j = 0; j < spokes; ++j) {
      const rho = Math.sqrt((i + 0.5) / rings), a = (2 * Math.PI * (j + 0.5)) / spokes;
      const w = [rho * Math.cos(a), rho * Math.sin(a), Math.sqrt(1 - rho * rho)] as const;
      const value = Math.max(0, w[0] * d[0] + w[1] * d[1] + w[2] * d[2]) ** exponent;
      zernikeBasis(lMax, w).forEach((basis, k) => (z[k] += (value * basis * Math.PI) / (rings * spokes)));
    }
  }
  return grey(lMax, z);
}

describe('A lobe', () => {
  it('keeps its flux at every degree', () => {
    const lobe: Lobe = { lMax: 12, channels: [some(12, 1), some(12, 2), some(12, 3)] };
    for (let degree = 0; degree <= 12; ++degree) expect(fluxOf(cutLobe(lobe, degree))).toEqual(fluxOf(lobe));
  });

  it('has the flux of a Lambertian radiance, π L', () => {
    expect(fluxOf(linear(0.5, 0))[1]).toBeCloseTo(0.5 * Math.PI, 12);
  });

  it('that is linear has a negative part that is known', () => {
    // L = 1 + 2 x is negative where x < -1/2: a segment of the disc.
    const area = Math.PI / 3 - Math.sqrt(3) / 4, moment = (2 / 3) * (3 / 4) ** 1.5;
    const expected = (2 * moment - area) / Math.PI;
    expect(measureLobe(linear(1, 2)).negative).toBeCloseTo(expected, 2);
    // Over solid angle: a spherical cap x < -1/2, halved by the horizon: area π/2, ∫ -x dω = 3π/8.
    const below = 2 * (3 * Math.PI) / 8 - Math.PI / 2;
    expect(measureLobe(linear(1, 2)).negativeFraction).toBeCloseTo(below / (2 * Math.PI + 2 * below), 2);
    expect(measureLobe(linear(1, 0.9)).negative).toBe(0);
  });

  it.each([[0, 0], [35, 20], [60, 250], [75, 359]])('has its peak where it was put: θ %i°, φ %i°', (theta, phi) => {
    const { peak } = measureLobe(phong(16, 12, theta, phi));
    const put = [Math.sin((theta * Math.PI) / 180) * Math.cos((phi * Math.PI) / 180),
      Math.sin((theta * Math.PI) / 180) * Math.sin((phi * Math.PI) / 180), Math.cos((theta * Math.PI) / 180)];
    const cosine = peak.direction.reduce((s, v, i) => s + v * put[i], 0);
    // What the cut does to a lobe beside the horizon moves its peak by a degree or two.
    expect((Math.acos(Math.min(1, cosine)) * 180) / Math.PI).toBeLessThan(2.5);
    expect(peak.luminance).toBeGreaterThan(0.9);
  });

  it('that is constant has its peak along the normal', () => {
    const { peak } = measureLobe(linear(0.3, 0));
    expect(peak.direction).toEqual([0, 0, 1]);
    expect([peak.thetaDegrees, peak.phiDegrees]).toEqual([0, 0]);
    expect(peak.luminance).toBeCloseTo(0.3, 12);
  });

  it('has a spectrum that sums to its energy', () => {
    const lobe: Lobe = { lMax: 7, channels: [some(7, 1), some(7, 2), some(7, 3)] };
    const rings = 200, spokes = 64;
    const grid = new PolarGrid(7, Array.from({ length: rings }, (_, i) => Math.sqrt((i + 0.5) / rings)), spokes);
    const energy = lobe.channels.reduce(
      (sum, z) => sum + grid.evaluate(z).reduce((s, v) => s + v * v, 0) * (Math.PI / (rings * spokes)), 0);
    expect(spectrumOf(lobe).reduce((s, v) => s + v, 0) / energy).toBeCloseTo(1, 3);
  });

  it('says the error of a cut as what is missing, relative', () => {
    const lobe: Lobe = { lMax: 3, channels: [some(3, 1), some(3, 2), some(3, 3)] };
    expect(errorOfCut(lobe, 3)).toBe(0);
    const energy = spectrumOf(lobe);
    expect(errorOfCut(lobe, 0) ** 2).toBeCloseTo((energy[1] + energy[2] + energy[3]) / (energy[0] + energy[1] + energy[2] + energy[3]), 12);
  });
});

describe('The polar grid', () => {
  it.each([[0, 8], [0.5, 8], [0, 12], [0.5, 12]] as const)('of offset %f and %i spokes says what the basis says, at every degree up to its own', (offset, spokes) => {
    const grid = new PolarGrid(9, [0, 0.3, 0.8, 1], spokes, offset);
    for (const degree of [0, 1, 4, 9]) {
      const z = some(degree, 5), values = grid.evaluate(z);
      grid.sines.forEach((rho, ring) => {
        for (let spoke = 0; spoke < spokes; ++spoke) {
          const a = grid.azimuth(spoke);
          const basis = zernikeBasis(degree, [rho * Math.cos(a), rho * Math.sin(a), Math.sqrt(1 - rho * rho)]);
          expect(values[ring * spokes + spoke]).toBeCloseTo(basis.reduce((s, b, k) => s + b * z[k], 0), 9);
        }
      });
    }
  });
});

describe('A slice', () => {
  it('runs from its azimuth over the pole to the other side', () => {
    const { values } = sliceOf(linear(1, 0.5), 0, 2);
    [1.5, 1, 0.5].forEach((v, i) => expect(values[i]).toBeCloseTo(v, 12));
    expect(reachOf([sliceOf(linear(1, -0.5), 90), sliceOf(linear(1, -0.5), 0)])).toBeCloseTo(1.5, 12);
  });
});

describe('The way from Z to H', () => {
  it.each([0, 1, 6, 20, 32])('is the inverse of the way there, at degree %i', (lMax) => {
    const h = some(lMax, 7), z = new Float64Array(h.length), back = new Float64Array(h.length);
    toZernike(lMax, h, z);
    toHemisphere(lMax, z, back);
    // The blocks' condition grows with the degree.
    back.forEach((value, k) => expect(value).toBeCloseTo(h[k], lMax > 20 ? 6 : 9));
  });

  it('gives coefficients that say the same', () => {
    const z = some(5, 2), h = new Float64Array(z.length), w = [0.36, 0.48, 0.8] as const;
    toHemisphere(5, z, h);
    const read = (c: Float64Array, b: Float64Array) => c.reduce((s, v, k) => s + v * b[k], 0);
    expect(read(h, hemisphereBasis(5, w))).toBeCloseTo(read(z, zernikeBasis(5, w)), 10);
    expect(radianceTowards(grey(5, z), w)[0]).toBeCloseTo(read(z, zernikeBasis(5, w)), 12);
  });
});
