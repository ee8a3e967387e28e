/** What materials emit, as a texture. An *emitter* is a material's front, 2 i, or its back, 2 i + 1. */
import { DataTexture, FloatType, NearestFilter, RGBAFormat, type Texture } from 'three';
import type { Material } from '../solution/solution';

const kColumns = 1024;

export function emissionTexture(materials: readonly Material[]): Texture {
  const rows = Math.max(1, Math.ceil((2 * materials.length) / kColumns));
  const data = new Float32Array(4 * kColumns * rows);
  materials.forEach((m, i) => {
    data.set(m.emission, 8 * i);
    if (m.doubleSided) data.set(m.emission, 8 * i + 4);
  });
  const texture = new DataTexture(data, kColumns, rows, RGBAFormat, FloatType);
  texture.minFilter = texture.magFilter = NearestFilter;
  texture.needsUpdate = true;
  return texture;
}

export const emissionGlsl = /* glsl */ `
uniform highp sampler2D emission;
vec3 emissionOf(int emitter) { return texelFetch(emission, ivec2(emitter % ${kColumns}, emitter / ${kColumns}), 0).rgb; }
`;
