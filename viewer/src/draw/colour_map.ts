/** The colours of numbers and of kinds, for pictures and legends alike: display sRGB, 0..1. */
import { DataTexture, LinearFilter, RGBAFormat, type Texture } from 'three';

export type Colour = [number, number, number];

/** Dark blue over magenta and orange to pale yellow: `lobe`'s own (render/false_colour.cpp), whose lightness rises
 *  evenly, so that it reads in grey too. */
const kStops: readonly Colour[] = [
  [10, 10, 36], [50, 22, 110], [122, 30, 130], [196, 52, 104], [236, 106, 58], [247, 168, 50], [252, 246, 190],
];

/** t in 0..1, cut there. */
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

/** What "kind" and "hidden" show; a node's number is its place in the list. */
export const categories: { readonly kind: readonly Category[]; readonly hidden: readonly Category[] } = {
  // Apart in lightness as well as in hue, so that eyes without red and green tell them from each other.
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

const kColumns = 256;

/** A row of colours: the scale, or the categories, each as wide as any other. */
export function colourTexture(list: readonly Category[] | null): Texture {
  const data = new Uint8Array(4 * kColumns);
  for (let i = 0; i < kColumns; ++i) {
    const colour = list ? list[Math.floor((i * list.length) / kColumns)].colour : colourAt(i / (kColumns - 1));
    data.set([...colour.map((v) => Math.round(255 * v)), 255], 4 * i);
  }
  const texture = new DataTexture(data, kColumns, 1, RGBAFormat);
  texture.minFilter = texture.magFilter = LinearFilter;
  texture.needsUpdate = true;
  return texture;
}

/** GLSL: `falseColour(x)`, display sRGB of a quantity x. */
export const falseColourGlsl = /* glsl */ `
uniform sampler2D colours;
uniform vec2 scale;        // low, high
uniform bool logarithmic;
uniform float kinds;       // how many categories there are; 0: a scale
vec3 falseColour(float x) {
  float t;
  if (kinds > 0.0) {
    t = (floor(x + 0.5) + 0.5) / kinds;
  } else {
    // A logarithm needs a floor: six decades are more than a screen shows.
    float low = logarithmic ? max(scale.x, max(scale.y, 1e-30) * 1e-6) : scale.x;
    t = logarithmic ? log2(max(x, low) / low) / log2(max(scale.y / low, 1.0 + 1e-6))
                    : (x - low) / max(scale.y - low, 1e-30);
    t = (clamp(t, 0.0, 1.0) * ${kColumns - 1}.0 + 0.5) / ${kColumns}.0;  // centres of the first and last texel
  }
  return texture(colours, vec2(t, 0.5)).rgb;
}
`;
