/** What is said of a lobe, by the definitions of `lobe inspect` (render/lobe_figures.h) and docs/conventions.md. */
import type { Vec3 } from '../sh/frame';
import type { Rgb } from '../solution/solution';
import { negativePart } from '../sh/negative_part';
import { PolarGrid } from '../sh/polar_grid';
import { coefficientIndex } from '../sh/zernike';
import { LobeReader, luminanceOf, radianceTowards, type Lobe } from './lobe';

export interface Peak {
  /** Local, unit: where luminance is greatest. */
  direction: Vec3;
  /** There, W m⁻² sr⁻¹. */
  luminance: number;
  radiance: Rgb;
  /** From the normal; from x, 0..360, 0 at the pole. */
  thetaDegrees: number;
  phiDegrees: number;
}

export interface Figures {
  /** ∫ L cos θ dω, W m⁻²: what a surface element sends out in all. */
  flux: Rgb;
  peak: Peak;
  /** Flux of luminance's negative part over its flux (conventions.md, "Negative part"); 0 of a black lobe. */
  negative: number;
  /** ∫ of the negative part of luminance over ∫ of its magnitude, dω: `negative_fraction` of `lobe inspect`. */
  negativeFraction: number;
}

/** The first coefficient over Z holds it all. */
export function fluxOf(lobe: Lobe): Rgb {
  return lobe.channels.map((z) => z[0] * Math.sqrt(Math.PI)) as Rgb;
}

/** ∫ |L|² cos θ dω of each degree, all channels together: energy[n] = Σ_m Σ_c z². */
export function spectrumOf(lobe: Lobe): number[] {
  return Array.from({ length: lobe.lMax + 1 }, (_, n) => {
    let sum = 0;
    for (const z of lobe.channels) for (let m = -n; m <= n; m += 2) sum += z[coefficientIndex(n, m)] ** 2;
    return sum;
  });
}

/** Relative error, L2 under the cosine over all channels, of a lobe cut at `degree`. */
export function errorOfCut(lobe: Lobe, degree: number): number {
  const energy = spectrumOf(lobe), sum = (values: number[]) => values.reduce((s, v) => s + v, 0);
  const all = sum(energy);
  return all > 0 ? Math.sqrt(sum(energy.slice(degree + 1)) / all) : 0;
}

// A page looks at lobes of a few degrees, again and again.
const grids = new Map<number, PolarGrid>();

/** Rings of equal height: equal solid angles. As many as render/lobe_figures.cpp takes. */
function solidGridFor(lMax: number): PolarGrid {
  let grid = grids.get(lMax);
  if (!grid) {
    const rings = Math.max(48, 4 * lMax);
    grid = new PolarGrid(lMax, Array.from({ length: rings }, (_, i) => Math.sqrt(1 - ((i + 0.5) / rings) ** 2)), 2 * rings, 0.5);
    grids.set(lMax, grid);
  }
  return grid;
}

/** Climbs by steps that halve whenever no neighbour is higher, in the disc, where nothing is singular at the pole. */
function climb(lobe: LobeReader, from: Vec3, start: number): Vec3 {
  let best = from, highest = lobe.at(from);
  for (let step = start; step > 1e-5; ) {
    let moved = false;
    for (let k = 0; k < 8; ++k) {
      let x = best[0] + step * Math.cos((k * Math.PI) / 4), y = best[1] + step * Math.sin((k * Math.PI) / 4);
      const length = Math.hypot(x, y);
      if (length > 1) (x /= length), (y /= length);
      const w: Vec3 = [x, y, Math.sqrt(Math.max(0, 1 - x * x - y * y))];
      const value = lobe.at(w);
      if (value > highest + 1e-12 * Math.abs(highest)) {
        highest = value;
        best = w;
        moved = true;
      }
    }
    if (!moved) step /= 2;
  }
  return best;
}

function peakOf(lobe: Lobe, luminance: Float64Array, solid: PolarGrid, values: Float64Array): Peak {
  const reader = new LobeReader(lobe.lMax, luminance);
  let best: Vec3 = [0, 0, 1], highest = reader.at(best);
  values.forEach((value, i) => {
    // Rounding must not decide where a constant lobe has its peak.
    if (!(value > highest + 1e-12 * Math.abs(highest))) return;
    highest = value;
    const rho = solid.sines[Math.floor(i / solid.spokes)], phi = solid.azimuth(i % solid.spokes);
    best = [rho * Math.cos(phi), rho * Math.sin(phi), Math.sqrt(1 - rho * rho)];
  });
  const direction = lobe.lMax > 0 ? climb(reader, best, 1 / solid.sines.length) : best;
  const [x, y, z] = direction, sine = Math.hypot(x, y);
  const phi = sine < 1e-9 ? 0 : (Math.atan2(y, x) * 180) / Math.PI;
  return {
    direction,
    luminance: reader.at(direction),
    radiance: radianceTowards(lobe, direction),
    thetaDegrees: (Math.atan2(sine, z) * 180) / Math.PI,
    phiDegrees: phi < 0 ? phi + 360 : phi,
  };
}

export function measureLobe(lobe: Lobe): Figures {
  const luminance = luminanceOf(lobe);
  const grid = solidGridFor(lobe.lMax), solid = grid.evaluate(luminance);
  let below = 0, magnitude = 0;
  for (const value of solid) {
    below += Math.max(0, -value);
    magnitude += Math.abs(value);
  }
  return {
    flux: fluxOf(lobe),
    peak: peakOf(lobe, luminance, grid, solid),
    negative: negativePart(lobe.lMax, luminance),
    negativeFraction: magnitude > 0 ? below / magnitude : 0,
  };
}
