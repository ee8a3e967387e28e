/** Radiance as the picture shows it, for what is drawn beside it: render/tone.cpp on the CPU, one channel. */
import type { ToneCurve } from '../draw/settings';

/** Where reinhard (SIGGRAPH 2002, eq. 4) and filmic (Hable, GDC 2010) reach 1. */
const kReinhardWhite = 4;
const kFilmicWhite = 5.6;

function hable(x: number): number {
  // Shoulder and linear strength, linear angle, toe strength, numerator, denominator: Hable's letters.
  const A = 0.15, B = 0.5, C = 0.1, D = 0.2, E = 0.02, F = 0.3;
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
