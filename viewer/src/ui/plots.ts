/** The pictures of the inspector, from the selection. */
import type { Selection, Seat } from '../inspect/selection';
import { sliceOf } from '../inspect/slices';
import { darkTheme, paperTheme, slicesSvg, type Curve } from '../inspect/slices_svg';
import { spectrumSvg } from '../inspect/spectrum_svg';
import { h, markup } from './dom';
import { number, percent } from './format';

/** Slices of both lobes in the plane of the first one's peak, and across; azimuths are of each node's own frame. */
function curves(selection: Selection, turn: number): Curve[] {
  const out: Curve[] = [];
  for (const seat of [0, 1] as const) {
    const i = selection.of(seat);
    if (!i?.shown || !i.whole || !i.figures) continue;
    // In whole degrees, so that neither the picture nor its scale misses the peak.
    const phi = (Math.round(i.figures.peak.phiDegrees) + turn) % 360;
    out.push({
      slice: sliceOf(i.shown, phi),
      ghost: i.shown.lMax < i.whole.lMax ? sliceOf(i.whole, phi) : undefined,
      colour: seat, unit: selection.unitOf(seat),
    });
  }
  return out;
}

export function slicesFigure(selection: Selection): HTMLElement {
  const both = [0, 1].map((seat) => selection.of(seat as Seat)).filter((i) => i?.whole);
  const cut = both.some((i) => i!.shown!.lMax < i!.whole!.lMax);
  const negative = both.some((i) => i!.figures!.negativeFraction > 0);
  const unit = selection.equalPeaks && both.length > 1 ? 'Luminance over the peak' : 'Luminance, W/(m² sr)';
  return h('figure', { className: 'plot' },
    markup(slicesSvg(curves(selection, 0), curves(selection, 90), {
      theme: darkTheme, width: 352, label: 'The lobe in the plane of its peak, and across it',
    })),
    h('figcaption', {}, unit, both.length > 1 ? '; the plane of each one’s own peak' : '', cut ? '; dotted: the whole lobe' : '',
      negative && h('span', { className: 'negative' }, '; blue: below zero')));
}

export function spectrumFigure(selection: Selection, degree: number): HTMLElement {
  const spectra = ([0, 1] as const).flatMap((seat) => {
    const i = selection.of(seat);
    return i?.whole ? [{ energy: i.spectrum, colour: seat }] : [];
  });
  return h('figure', { className: 'plot' }, markup(spectrumSvg(spectra, degree, darkTheme, 352)),
    h('figcaption', {}, 'Share of energy by degree'));
}

/** For paper: with the numbers, as `lobe inspect -o lobe.svg` has them. */
export function slicesDrawing(selection: Selection): string {
  const said = ([0, 1] as const).map((seat) => selection.of(seat)).filter((i) => i?.figures);
  const title = said.map((i) => `node ${i!.node} on '${i!.surface}', ${i!.material}`).join('; ');
  const notes = said.map((i) => {
    const { flux, peak, negative } = i!.figures!;
    return (
      `node ${i!.node}: flux ${flux.map((v) => number(v)).join(', ')} W/m²; peak ${number(peak.luminance)} W/(m² sr) at θ ` +
      `${peak.thetaDegrees.toFixed(1)}°, φ ${peak.phiDegrees.toFixed(1)}°; negative part ${percent(negative)} of the flux; ` +
      `degree ${i!.shown!.lMax} of ${i!.whole!.lMax}`);
  });
  return slicesSvg(curves(selection, 0), curves(selection, 90), { theme: paperTheme, width: 900, title, notes });
}
