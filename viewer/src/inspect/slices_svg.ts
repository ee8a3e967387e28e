/** Slices as SVG text: for the panel on dark ground, for a file on paper. */
import { kLobeColours, kNegativeColour } from './colours';
import { reachOf, type Slice } from './slices';

export interface SlicesTheme {
  ink: string;
  faint: string;
  grid: string;
  lobes: readonly string[];
  negative: string;
  font: string;
}

const kFont = 'system-ui, sans-serif';
export const darkTheme: SlicesTheme = {
  ink: '#d6d8e0', faint: '#8f93a3', grid: '#34373f', lobes: kLobeColours, negative: kNegativeColour, font: kFont,
};
/** The colours of `lobe inspect -o lobe.svg` (render/lobe_plot.cpp). */
export const paperTheme: SlicesTheme = {
  ink: '#222228', faint: '#6e6e7a', grid: '#d6d7de', lobes: ['#c44824', '#00785a'], negative: '#1868c4', font: kFont,
};

/** A lobe's slice in a plot; `ghost`: the same slice of the whole lobe, drawn as a line behind. */
export interface Curve {
  slice: Slice;
  ghost?: Slice;
  /** Which of the theme's lobe colours. */
  colour: number;
  /** Divides the values; 1 unless lobes are shown each by its own peak. */
  unit?: number;
}

/** The next of 1, 2, 2.5, 5 times a power of ten that is at least `value`. */
export function roundUp(value: number): number {
  if (!(value > 0)) return 1;
  const power = 10 ** Math.floor(Math.log10(value));
  const step = [1, 2, 2.5, 5].find((s) => value <= s * power * (1 + 1e-9));
  return (step ?? 10) * power;
}

const escape = (text: string) => text.replace(/&/g, '&amp;').replace(/</g, '&lt;').replace(/"/g, '&quot;');
const p = (x: number, y: number) => `${x.toFixed(2)} ${y.toFixed(2)}`;
export const short = (value: number) => String(Number(value.toPrecision(3)));

/** Runs of one sign as outlines from the centre; negative ones by magnitude, dashed. */
function runs(values: readonly number[]): { negative: boolean; begin: number; end: number }[] {
  const out: { negative: boolean; begin: number; end: number }[] = [];
  for (let begin = 0; begin < values.length; ) {
    const negative = values[begin] < 0;
    let end = begin;
    while (end < values.length && values[end] < 0 === negative) ++end;
    out.push({ negative, begin, end });
    begin = end;
  }
  return out;
}

interface Place {
  x: number;
  y: number;
  radius: number;
  full: number;
}

function outline(values: readonly number[], unit: number, at: Place, begin = 0, end = values.length): string[] {
  const points: string[] = [];
  for (let i = begin; i < end; ++i) {
    const t = (Math.PI * i) / (values.length - 1), r = (Math.abs(values[i]) / unit / at.full) * at.radius;
    points.push(p(at.x + r * Math.cos(t), at.y - r * Math.sin(t)));
  }
  return points;
}

function grid(at: Place, theme: SlicesTheme): string {
  const parts: string[] = [];
  const label = (x: number, y: number, words: string, anchor: string) =>
    `<text x="${x.toFixed(1)}" y="${y.toFixed(1)}" text-anchor="${anchor}" fill="${theme.faint}">${words}</text>`;
  for (const k of [0.5, 1]) {
    const r = at.radius * k;
    parts.push(`<path d="M${p(at.x - r, at.y)} A${r} ${r} 0 0 1 ${p(at.x + r, at.y)}" fill="none" stroke="${theme.grid}"/>`);
  }
  for (let theta = -90; theta <= 90; theta += 30) {
    const t = Math.PI / 2 - (theta * Math.PI) / 180, x = Math.cos(t), y = -Math.sin(t);
    parts.push(`<path d="M${p(at.x, at.y)} L${p(at.x + at.radius * x, at.y + at.radius * y)}" stroke="${theme.grid}"/>`);
    if (Math.abs(theta) === 90) continue;
    const anchor = theta === 0 ? 'middle' : theta > 0 ? 'start' : 'end', gap = at.radius + 4;
    parts.push(label(at.x + gap * x, at.y + gap * y + (theta === 0 ? 0 : 2), `${Math.abs(theta)}°`, anchor));
  }
  for (const k of [0, 0.5, 1]) parts.push(label(at.x + at.radius * k, at.y + 13, short(at.full * k), 'middle'));
  return parts.join('');
}

function curve(c: Curve, at: Place, theme: SlicesTheme, filled: boolean): string {
  const { values } = c.slice, unit = c.unit ?? 1, colour = theme.lobes[c.colour];
  const parts: string[] = [];
  if (c.ghost) {
    const whole = outline(c.ghost.values, unit, at).join('L');
    parts.push(`<path d="M${whole}" fill="none" stroke="${theme.faint}" stroke-dasharray="2 2.5"/>`);
  }
  const centre = p(at.x, at.y);
  for (const { negative, begin, end } of runs(values)) {
    const points = outline(values, unit, at, begin, end);
    const stroke = negative ? theme.negative : colour;
    if (filled || negative) {
      parts.push(`<path d="M${centre}L${points.join('L')}Z" fill="${stroke}" fill-opacity="0.2"/>`);
    }
    // On the horizon the outline ends; the spoke back to the centre is not part of the curve.
    if (begin > 0) points.unshift(centre);
    if (end < values.length) points.push(centre);
    const dashes = negative ? ' stroke-dasharray="3 2"' : '';
    parts.push(
      `<path d="M${points.join('L')}" fill="none" stroke="${stroke}" stroke-width="1.6" stroke-linejoin="round"${dashes}/>`);
  }
  return parts.join('');
}

/** One half-disc of slices through one plane. Labels in units of the values: W/(m² sr), or of peaks. */
export function sliceSvg(
  curves: readonly Curve[], title: string, theme: SlicesTheme, width: number, full: number, x = 0, y = 0,
): string {
  const at: Place = { x: x + width / 2, y: y + width / 2 - 4, radius: width / 2 - 19, full };
  // To the right; where two lobes are drawn, each has its own.
  const turn = curves.length === 1 ? `, φ ${Math.round(curves[0].slice.phiDegrees)}° →` : '';
  return (
    `<g font-size="10" font-family="${theme.font}">` + grid(at, theme) +
    curves.map((c) => curve(c, at, theme, curves.length === 1)).join('') +
    `<text x="${at.x}" y="${at.y + 29}" text-anchor="middle" fill="${theme.ink}" font-size="11">${escape(title)}${turn}</text></g>`
  );
}

/** Both planes: `along` and `across`, one below the other or side by side. */
export function slicesSvg(
  along: readonly Curve[], across: readonly Curve[],
  options: { theme: SlicesTheme; width: number; title?: string; notes?: readonly string[]; label?: string },
): string {
  const { theme, width } = options;
  const every = [...along, ...across];
  const full = roundUp(
    every.reduce((m, c) => Math.max(m, reachOf(c.ghost ? [c.slice, c.ghost] : [c.slice]) / (c.unit ?? 1)), 0));
  const one = width / 2, top = options.title ? 44 : 8;
  const notes = options.notes ?? [];
  const height = top + one / 2 + 36 + (notes.length > 0 ? 12 + notes.length * 17 : 0);
  const text = (x: number, y: number, size: number, colour: string, words: string) =>
    `<text x="${x}" y="${y}" font-size="${size}" font-family="${theme.font}" fill="${colour}">${escape(words)}</text>`;
  return (
    `<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 ${width} ${height}" role="img" ` +
    `aria-label="${escape(options.label ?? options.title ?? '')}">` +
    (options.title ? text(16, 28, 15, theme.ink, options.title) : '') +
    sliceSvg(along, 'through the peak', theme, one, full, 0, top) +
    sliceSvg(across, 'across it', theme, one, full, one, top) +
    notes.map((note, i) => text(16, top + one / 2 + 56 + 17 * i, 12, theme.faint, note)).join('') +
    '</svg>'
  );
}
