/**
 * What the page needs of draw/: the one place to change when that room changes. Colours are provisional, until draw/ has
 * its own (colour_map.ts); what a Stage may already say for itself is asked of it.
 */
import type { Solution } from '../solution/solution';
import type { Quantity } from '../stage/settings';
import type { Stage } from '../stage/stage';

export type Colour = [number, number, number];

const kStops: readonly Colour[] = [
  [10, 10, 36], [50, 22, 110], [122, 30, 130], [196, 52, 104], [236, 106, 58], [247, 168, 50], [252, 246, 190],
];

/** Of the scale, display sRGB 0..1; t in 0..1. */
export function colourAt(t: number): Colour {
  const x = Math.min(1, Math.max(0, t || 0)) * (kStops.length - 1);
  const i = Math.min(Math.floor(x), kStops.length - 2);
  const mix = (c: 0 | 1 | 2) => (kStops[i][c] + (x - i) * (kStops[i + 1][c] - kStops[i][c])) / 255;
  return [mix(0), mix(1), mix(2)];
}

export interface Category {
  name: string;
  colour: Colour;
}

/** Of quantities that are kinds and not numbers. */
export const categories: { readonly kind: readonly Category[]; readonly hidden: readonly Category[] } = {
  kind: [
    { name: 'none', colour: [0.36, 0.38, 0.42] },
    { name: 'lobe', colour: [0.25, 0.55, 0.85] },
    { name: 'sharp', colour: [0.95, 0.7, 0.25] },
    { name: 'mirror', colour: [0.93, 0.93, 0.9] },
  ],
  hidden: [
    { name: 'seen', colour: [0.36, 0.38, 0.42] },
    { name: 'hidden', colour: [0.95, 0.35, 0.2] },
  ],
};

interface AbleStage {
  whyNot?(quantity: Quantity): string | null;
  range?(quantity: Quantity): { low: number; high: number };
  capture?(width: number, height: number, options: { overlay: boolean }):
    { width: number; height: number; pixels: Uint8ClampedArray };
}

/** Why a quantity cannot be shown, in one sentence; null: it can. */
export function whyNot(stage: Stage & AbleStage, quantity: Quantity): string | null {
  if (stage.whyNot) return stage.whyNot(quantity);
  const solution: Solution = stage.solution;
  if (quantity === 'irradiance' && !solution.materials.some((m) => m.albedo)) {
    return 'The file does not hold its materials’ albedos.';
  }
  return null;
}

/** A scale that suits a quantity in this solution, its own unit. */
export function rangeOf(stage: Stage & AbleStage, quantity: Quantity): { low: number; high: number } {
  if (stage.range) return stage.range(quantity);
  const { solution } = stage;
  const bright = 1 / solution.exposureScale;
  const lMax = Math.max(0, ...solution.patches.map((p) => p.lobes?.lMax ?? 0));
  const high = { radiance: bright, irradiance: Math.PI * bright, density: 100, degree: lMax || 1, negative: 0.2, hidden: 1, kind: 3 };
  return { low: 0, high: high[quantity] };
}

/** The picture as it is shown, as PNG. */
export async function capture(stage: Stage & AbleStage): Promise<Blob> {
  const { canvas } = stage;
  let source: HTMLCanvasElement = canvas;
  if (stage.capture) {
    const { width, height, pixels } = stage.capture(canvas.width, canvas.height, { overlay: true });
    source = document.createElement('canvas');
    source.width = width;
    source.height = height;
    source.getContext('2d')!.putImageData(new ImageData(new Uint8ClampedArray(pixels), width, height), 0, 0);
  } else {
    stage.drawNow();
  }
  return new Promise((resolve, reject) =>
    source.toBlob((blob) => (blob ? resolve(blob) : reject(new Error('the browser makes no PNG of it'))), 'image/png'));
}
