/** Numbers for people. */

const kMinus = '−';

/** Three digits that count; powers of ten beyond what reads well. */
export function number(value: number, digits = 3): string {
  if (value === 0) return '0';
  const size = Math.abs(value);
  if (!Number.isFinite(value)) return value > 0 ? '∞' : Number.isNaN(value) ? '–' : `${kMinus}∞`;
  let text: string;
  if (size >= 1e5 || size < 1e-3) {
    const [mantissa, exponent] = value.toExponential(digits - 1).split('e');
    text = `${mantissa}·10${superscript(Number(exponent))}`;
  } else {
    text = value.toPrecision(digits);
    if (text.includes('e')) text = String(Number(text));
  }
  return text.replace('-', kMinus);
}

function superscript(exponent: number): string {
  return String(exponent).replace('-', '⁻').replace(/\d/g, (d) => '⁰¹²³⁴⁵⁶⁷⁸⁹'[Number(d)]);
}

/** A share as percent. */
export function percent(share: number): string {
  const value = 100 * share;
  return `${value === 0 ? '0' : value < 0.01 ? '< 0.01' : value < 10 ? value.toFixed(2) : value.toFixed(1)} %`;
}

/** Metres, to the millimetre. */
export function metres(value: number): string {
  return (Object.is(value, -0) || Math.abs(value) < 5e-4 ? 0 : value).toFixed(3).replace('-', kMinus);
}

export function signed(value: number, digits: number): string {
  return `${value < 0 ? kMinus : '+'}${Math.abs(value).toFixed(digits)}`;
}

/** A direction, to a thousandth. */
export function vector(v: readonly number[], between = ', '): string {
  return v.map(metres).join(between);
}

/** Ticks at round numbers, about `count` of them, from low to high. */
export function ticks(low: number, high: number, logarithmic: boolean, count = 5): number[] {
  if (!(high > low)) return [];
  if (logarithmic && low > 0) {
    const from = Math.ceil(Math.log10(low) - 1e-9), to = Math.floor(Math.log10(high) + 1e-9);
    const step = Math.max(1, Math.ceil((to - from) / count));
    const out: number[] = [];
    for (let e = from; e <= to; e += step) out.push(10 ** e);
    if (out.length >= 2) return out;
    return [low, Math.sqrt(low * high), high].map((v) => Number(v.toPrecision(2)));
  }
  const rough = (high - low) / count, power = 10 ** Math.floor(Math.log10(rough));
  const step = [1, 2, 5, 10].map((s) => s * power).find((s) => s >= rough * (1 - 1e-9))!;
  const out: number[] = [];
  for (let i = Math.ceil(low / step - 1e-9); i * step <= high + 1e-9 * step; ++i) out.push(Number((i * step).toPrecision(12)));
  return out;
}

/** As a file's name: what stands before the last ending, without what file systems mind. */
export function stem(title: string): string {
  return title.replace(/\.(glb|gltf)(\.gz)?$/i, '').replace(/[^\p{L}\p{N}._-]+/gu, '_') || 'lobe';
}
