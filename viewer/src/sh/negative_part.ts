import { PolarGrid } from './polar_grid';

const grids = new Map<number, PolarGrid>();

/** Rings of equal area of the disc: equal shares of cos θ dω. As many as brdf/lobe_accuracy.cpp takes. */
function gridFor(lMax: number): PolarGrid {
  let grid = grids.get(lMax);
  if (!grid) {
    const rings = 24 + 2 * lMax;
    grid = new PolarGrid(lMax, Array.from({ length: rings }, (_, i) => Math.sqrt((i + 0.5) / rings)), 2 * rings, 0.5);
    grids.set(lMax, grid);
  }
  return grid;
}

/** The flux of what is below zero, over the flux (docs/conventions.md, "Negative part"); 0 of a black lobe. `z`: the
 *  lobe's coefficients over Zernike's basis. */
export function negativePart(lMax: number, z: Float64Array): number {
  const flux = z[0] * Math.sqrt(Math.PI);
  if (!(flux > 0)) return 0;
  const values = gridFor(lMax).evaluate(z);
  let below = 0;
  for (const value of values) below += Math.max(0, -value);
  return (below * Math.PI) / values.length / flux;
}
