/** Half circles of directions over the pole: a lobe in the plane of its peak, and across it. */
import { LobeReader, luminanceOf, type Lobe } from './lobe';

/** Luminance from the horizon at azimuth `phiDegrees` (first) over the pole to the other horizon (last), in equal
 *  steps of angle. */
export interface Slice {
  phiDegrees: number;
  values: number[];
}

export function sliceOf(lobe: Lobe, phiDegrees: number, steps = Math.max(120, 10 * lobe.lMax)): Slice {
  const reader = new LobeReader(lobe.lMax, luminanceOf(lobe));
  const phi = (phiDegrees * Math.PI) / 180;
  const values = Array.from({ length: steps + 1 }, (_, i) => {
    const t = (Math.PI * i) / steps, sine = Math.cos(t);
    return reader.at([sine * Math.cos(phi), sine * Math.sin(phi), Math.sin(t)]);
  });
  return { phiDegrees, values };
}

/** The greatest magnitude in slices. */
export function reachOf(slices: readonly Slice[]): number {
  return slices.reduce((most, slice) => slice.values.reduce((m, v) => Math.max(m, Math.abs(v)), most), 0);
}
