import { readFileSync, writeFileSync } from 'node:fs';
import { PNG } from './packages.mjs';

/** {width, height, data}, RGBA. */
export const readPng = (file) => PNG.sync.read(readFileSync(file));

export function writePng(file, { width, height, data }) {
  const png = new PNG({ width, height });
  data.copy(png.data);
  writeFileSync(file, PNG.sync.write(png));
}

/** Of all pixels and colour channels, 0..255. */
export function mean({ data }) {
  let sum = 0;
  for (let i = 0; i < data.length; ++i) if (i % 4 !== 3) sum += data[i];
  return sum / (0.75 * data.length);
}

/**
 * Pixels within two of a jump of the picture, 1 each: silhouettes and borders of shadows and lamps, where one eye ray a
 * pixel and sixteen may disagree by the whole jump. A jump: neighbours that differ by more than `step` in a channel.
 */
export function nearJumps({ width, height, data }, step = 12, reach = 2) {
  const out = new Uint8Array(width * height);
  const mark = (x, y) => {
    for (let v = Math.max(0, y - reach); v <= Math.min(height - 1, y + reach); ++v) {
      out.fill(1, v * width + Math.max(0, x - reach), v * width + Math.min(width - 1, x + reach) + 1);
    }
  };
  const jumps = (i, k) => [0, 1, 2].some((c) => Math.abs(data[4 * i + c] - data[4 * k + c]) > step);
  for (let y = 0; y < height; ++y) {
    for (let x = 0; x < width; ++x) {
      const i = y * width + x;
      if ((x + 1 < width && jumps(i, i + 1)) || (y + 1 < height && jumps(i, i + width))) mark(x, y);
    }
  }
  return out;
}

/**
 * Mean of |a - b| by channel, 0..255, over pixels that `excluded` (if given) does not mark, and of b - a; their share of
 * all; and the share of them where a channel is off by more than 16, which anybody sees.
 */
export function difference(a, b, excluded = null) {
  const sums = [0, 0, 0], signed = [0, 0, 0], pixels = a.width * a.height;
  let kept = 0, far = 0;
  for (let i = 0; i < pixels; ++i) {
    if (excluded?.[i]) continue;
    ++kept;
    let most = 0;
    for (let c = 0; c < 3; ++c) {
      const off = b.data[4 * i + c] - a.data[4 * i + c];
      signed[c] += off;
      sums[c] += Math.abs(off);
      most = Math.max(most, Math.abs(off));
    }
    if (most > 16) ++far;
  }
  const mean = (values) => values.map((s) => s / kept);
  return { byChannel: mean(sums), signed: mean(signed), share: kept / pixels, far: far / kept };
}

/** What a display shows of linear light, 0..255. */
export const srgb = (linear) => {
  const v = Math.min(1, Math.max(0, linear));
  return 255 * (v <= 0.0031308 ? 12.92 * v : 1.055 * v ** (1 / 2.4) - 0.055);
};
