import { describe, expect, it } from 'vitest';
import { frameOf, toLocal, toWorld, type Vec3 } from '../src/sh/frame';
import { coefficientCount, hemisphereBasis, toZernike, zernikeBasis } from '../src/sh/zernike';

// Generic directions of the upper hemisphere: a lattice turned off every axis.
function directions(count: number): Vec3[] {
  return Array.from({ length: count }, (_, i) => {
    const u = (i + 0.5) / count, phi = 2.399963 * i + 0.3;
    const rho = Math.sqrt(u);
    return [rho * Math.cos(phi), rho * Math.sin(phi), Math.sqrt(1 - u)];
  });
}

const sum = (a: ArrayLike<number>, b: ArrayLike<number>) => Array.from(a).reduce((s, v, i) => s + v * b[i], 0);

describe('The hemisphere basis', () => {
  it('has the documented signs and scales', () => {
    const [x, y, z] = [0.36, 0.48, 0.8];
    const h = hemisphereBasis(2, [x, y, z]);
    const expected = [
      1 / Math.sqrt(2 * Math.PI), Math.sqrt(3 / (2 * Math.PI)) * y, Math.sqrt(3 / (2 * Math.PI)) * x,
      Math.sqrt(15 / (2 * Math.PI)) * x * y, Math.sqrt(5 / (8 * Math.PI)) * (3 * z * z - 1),
      Math.sqrt(15 / (8 * Math.PI)) * (x * x - y * y),
    ];
    expected.forEach((value, k) => expect(h[k]).toBeCloseTo(value, 12));
  });
});

describe('Zernike', () => {
  it('is orthonormal over the disc', () => {
    const lMax = 8, n = coefficientCount(lMax), points = directions(200000);
    const gram = new Float64Array(n * n);
    const z = new Float64Array(n);
    for (const d of points) {
      zernikeBasis(lMax, d, z);
      for (let i = 0; i < n; ++i) for (let k = 0; k <= i; ++k) gram[i * n + k] += (z[i] * z[k] * Math.PI) / points.length;
    }
    for (let i = 0; i < n; ++i) for (let k = 0; k <= i; ++k) expect(gram[i * n + k]).toBeCloseTo(i === k ? 1 : 0, 2);
  });

  it.each([0, 1, 2, 5, 12, 20, 32])('says the same of a lobe as H does, at degree %i', (lMax) => {
    const n = coefficientCount(lMax);
    const h = Float64Array.from({ length: n }, (_, k) => Math.sin(3 * k + 1));
    const z = new Float64Array(n);
    toZernike(lMax, h, z);
    for (const d of directions(50)) {
      expect(sum(zernikeBasis(lMax, d), z)).toBeCloseTo(sum(hemisphereBasis(lMax, d), h), 8);
    }
  });

  it('holds the flux in its first coefficient', () => {
    const lMax = 6, n = coefficientCount(lMax), points = directions(200000);
    const h = Float64Array.from({ length: n }, (_, k) => Math.cos(2 * k));
    const z = new Float64Array(n);
    toZernike(lMax, h, z);
    const flux = points.reduce((s, d) => s + sum(hemisphereBasis(lMax, d), h), 0) * (Math.PI / points.length);
    expect(z[0] * Math.sqrt(Math.PI)).toBeCloseTo(flux, 3);
  });
});

describe('A frame', () => {
  it('has the documented axes', () => {
    const f = frameOf([0, 1, 0]);
    [f.x, f.y, f.z].flat().forEach((v, i) => expect(v).toBeCloseTo([1, 0, 0, 0, 0, -1, 0, 1, 0][i], 12));
  });

  it('takes directions there and back, and bends what is below the horizon to it', () => {
    const f = frameOf([0.48, -0.6, -0.64]);
    for (const d of directions(20)) {
      const w = toWorld(f, d);
      toLocal(f, w).forEach((v, i) => expect(v).toBeCloseTo(d[i], 12));
      const [x, y, z] = toLocal(f, toWorld(f, [d[0], d[1], -d[2]]));
      expect(z).toBe(0);
      expect(Math.hypot(x, y)).toBeCloseTo(1, 12);
    }
  });
});
