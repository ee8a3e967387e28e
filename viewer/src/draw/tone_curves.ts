/** The curves of render/tone.cpp, one channel: for the picture, and for what is drawn beside it. */
import { toneCurves, type ToneCurve } from './settings';

/** Where reinhard (SIGGRAPH 2002, eq. 4) and filmic (Hable, GDC 2010) reach 1. */
const kReinhardWhite = 4;
const kFilmicWhite = 5.6;

// Shoulder and linear strength, linear angle, toe strength, numerator, denominator: Hable's letters.
const A = 0.15, B = 0.5, C = 0.1, D = 0.2, E = 0.02, F = 0.3;

function hable(x: number): number {
  return (x * (A * x + C * B) + D * E) / (x * (A * x + B) + D * F) - E / F;
}

/** Linear light of the display, 0..1. `x`: radiance times 2^exposure. */
export function toneMap(curve: ToneCurve, x: number): number {
  if (!(x > 0)) return 0;
  switch (curve) {
    case 'srgb':
      return Math.min(1, x);
    case 'reinhard':
      return x >= kReinhardWhite ? 1 : Math.min(1, (x * (1 + x / kReinhardWhite ** 2)) / (1 + x));
    case 'filmic':
      return x >= kFilmicWhite ? 1 : Math.max(0, Math.min(1, hable(2 * x) / hable(2 * kFilmicWhite)));
  }
}

/** GLSL: `curved(v)`, by the `curve` that is chosen, its place in toneCurves. */
export const curveGlsl = /* glsl */ `
uniform int curve;
float reinhard(float x) {
  return x >= float(${kReinhardWhite}) ? 1.0 : min(1.0, x * (1.0 + x / float(${kReinhardWhite ** 2})) / (1.0 + x));
}
float hableUnscaled(float x) {
  const float A = float(${A}), B = float(${B}), C = float(${C}), D = float(${D}), E = float(${E}), F = float(${F});
  return (x * (A * x + C * B) + D * E) / (x * (A * x + B) + D * F) - E / F;
}
float hable(float x) {
  const float white = float(${kFilmicWhite});
  return x >= white ? 1.0 : clamp(hableUnscaled(2.0 * x) / hableUnscaled(2.0 * white), 0.0, 1.0);
}
vec3 curved(vec3 v) {
  if (curve == ${toneCurves.indexOf('reinhard')}) return vec3(reinhard(v.r), reinhard(v.g), reinhard(v.b));
  if (curve == ${toneCurves.indexOf('filmic')}) return vec3(hable(v.r), hable(v.g), hable(v.b));
  return min(v, 1.0);
}
`;
