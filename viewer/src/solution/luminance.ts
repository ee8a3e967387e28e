import type { Rgb } from './solution';

/** ITU-R BT.709-6, item 3.2: as everywhere in Lobe. */
export const kLuminance: Rgb = [0.2126, 0.7152, 0.0722];

export function luminance(colour: ArrayLike<number>): number {
  return kLuminance[0] * colour[0] + kLuminance[1] * colour[1] + kLuminance[2] * colour[2];
}
