/** IEEE half precision, of many numbers at once. */

/** `values` times `scale`, rounded to the nearest half (three's own cuts, which is biased); beyond ±65504: that. */
export function toHalves(values: Float32Array, scale: number, out: Uint16Array, at = 0): void {
  const float = new Float32Array(1), bits = new Uint32Array(float.buffer);
  for (let i = 0; i < values.length; ++i) out[at + i] = toHalf(values[i] * scale, float, bits);
}

function toHalf(value: number, float: Float32Array, bits: Uint32Array): number {
  const size = Math.abs(value), sign = value < 0 ? 0x8000 : 0;
  if (size >= 65504) return sign | 0x7bff;
  // Below 2^-14 halves are equally spaced, 2^-24 apart.
  if (size < 2 ** -14) return sign | Math.round(size * 2 ** 24);
  float[0] = size;
  // Exponents are biased by 127 and 15; a carry out of the mantissa is right, too.
  return sign | ((bits[0] + 0x1000 - ((127 - 15) << 23)) >>> 13);
}

/** The power of two that brings `largest` just below 2^14, so that 28 binary orders below it keep all 11 digits. */
export function halfScale(largest: number): number {
  return largest > 0 && Number.isFinite(largest) ? 2 ** (14 - Math.ceil(Math.log2(largest))) : 1;
}
