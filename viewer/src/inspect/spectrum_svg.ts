/** Energy by degree as bars, SVG text. A logarithmic share: lobes fall by decades. */
import type { SlicesTheme } from './slices_svg';

/** Decades below all of the energy that are shown. */
const kDecades = 6;

export interface Spectrum {
  /** spectrumOf, of a whole lobe. */
  energy: readonly number[];
  colour: number;
}

/** Bars beyond `degree` are faint: that is what a cut leaves out. */
export function spectrumSvg(spectra: readonly Spectrum[], degree: number, theme: SlicesTheme, width: number): string {
  const height = 96, left = 30, top = 6, bottom = 16;
  const plot = { width: width - left - 4, height: height - top - bottom };
  const lMax = Math.max(...spectra.map((s) => s.energy.length - 1));
  const step = plot.width / (lMax + 1), gap = Math.min(2, step * 0.25);
  const level = (share: number) => Math.max(0, 1 + Math.log10(Math.max(share, 1e-30)) / kDecades);
  const parts: string[] = [];
  for (let decade = 0; decade <= kDecades; decade += 2) {
    const y = top + (plot.height * decade) / kDecades;
    parts.push(`<path d="M${left} ${y}H${width - 4}" stroke="${theme.grid}"/>`);
    const words = decade === 0 ? '1' : `10<tspan dy="-3" font-size="7">−${decade}</tspan>`;
    parts.push(`<text x="${left - 5}" y="${y + 3.5}" text-anchor="end" fill="${theme.faint}">${words}</text>`);
  }
  spectra.forEach(({ energy, colour }, which) => {
    const all = energy.reduce((s, v) => s + v, 0);
    if (!(all > 0)) return;
    const bar = Math.min(18, (step - gap) / spectra.length);
    energy.forEach((value, n) => {
      const h = plot.height * level(value / all);
      if (h <= 0) return;
      const x = left + step * (n + 0.5) + bar * (which - spectra.length / 2), y = top + plot.height - h;
      const wide = Math.max(0.8, bar - (spectra.length > 1 ? 0.5 : 0));
      parts.push(
        `<rect x="${x.toFixed(2)}" y="${y.toFixed(2)}" width="${wide.toFixed(2)}" height="${h.toFixed(2)}" rx="1" ` +
        `fill="${theme.lobes[colour]}" fill-opacity="${n > degree ? 0.22 : 1}">` +
        `<title>degree ${n}: ${((100 * value) / all).toPrecision(3)} %</title></rect>`);
    });
  });
  const every = Math.max(1, Math.ceil((lMax + 1) / (plot.width / 22)));
  const stride = [1, 2, 5, 10, 20].find((s) => s >= every) ?? 20;
  for (let n = 0; n <= lMax; n += stride) {
    const x = left + step * (n + 0.5);
    parts.push(`<text x="${x.toFixed(1)}" y="${height - 4}" text-anchor="middle" fill="${theme.faint}">${n}</text>`);
  }
  return (
    `<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 ${width} ${height}" font-size="9.5" font-family="${theme.font}" ` +
    `role="img" aria-label="Share of the lobe's energy by degree, logarithmic">` +
    parts.join('') + '</svg>'
  );
}
