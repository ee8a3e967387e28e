/**
 * A solution's lobes as textures, and the GLSL that reads them: `lobeOf`.
 *
 * - `coefficients`: half (or float) RGB, one coefficient over Zernike's basis a texel, node after node, k within a
 *   node, running on through the rows and layers of a 2D array.
 * - `table`: two texels of 128 bits a glossy node: position and first coefficient, normal and degree.
 * - `steps`: the recurrence's constants (a, b, c) and the scale of R_n^m, at (j, m), n = m + 2 j.
 */
import {
  DataArrayTexture, DataTexture, FloatType, HalfFloatType, NearestFilter, RGBAFormat, RGBAIntegerFormat, RGBFormat,
  UnsignedIntType, type IUniform, type Texture,
} from 'three';
import { zernikeScale, zernikeStep } from '../sh/zernike';
import { Problem } from '../solution/problem';
import { kMostDegree, type Solution } from '../solution/solution';
import { halfScale, toHalves } from './half';
import type { Layout } from './layout';

/** Every WebGL2 has textures of 2048; powers of two make addresses of shifts. */
const kSide = 2048;
/** Glossy nodes in a row of `table`, and of what is evaluated of them. */
export const kNodesInRow = kSide / 2;

/** What a GPU's textures hold at most: pixels along a side, layers. */
export interface TextureLimits {
  side: number;
  layers: number;
}

/** Throws Problem if a GPU cannot hold a solution's lobes: with the least that WebGL 2 has, from two million glossy nodes
 *  on, or a thousand million coefficients; most cards have room for eight times as many. */
export function checkRoom(layout: Layout, { side, layers }: TextureLimits): void {
  const glossy = layout.nodeCount - layout.flatCount;
  for (const [what, count, most] of [
    ['glossy nodes', glossy, side * kNodesInRow], ['coefficients of lobes', layout.coefficientCount, layers * kSide ** 2],
  ] as const) {
    if (count > most) {
      throw new Problem(`The solution has ${count} ${what}, and the graphics card has room for ${most}: solve it with larger elements or a lower --lmax.`);
    }
  }
}

export type Precision = 'half' | 'float';

export class LobeTextures {
  readonly uniforms: Record<'coefficients' | 'coefficientUnit' | 'table' | 'steps' | 'degree', IUniform>;

  constructor(solution: Solution, layout: Layout, precision: Precision) {
    const { texture, unit } = coefficientTexture(solution, layout, precision);
    this.uniforms = {
      coefficients: { value: texture },
      coefficientUnit: { value: unit },
      table: { value: tableTexture(layout) },
      steps: { value: stepTexture() },
      degree: { value: kMostDegree },
    };
  }
}

/** Exact texels, no mipmaps. What is uploaded is no longer needed here: Picture makes everything anew if the GPU
 *  forgets it. */
function asTable<T extends Texture>(texture: T): T {
  texture.minFilter = texture.magFilter = NearestFilter;
  texture.generateMipmaps = false;
  texture.needsUpdate = true;
  texture.onUpdate = () => {
    (texture.image as { data: unknown }).data = null;
  };
  return texture;
}

function coefficientTexture(solution: Solution, layout: Layout, precision: Precision): { texture: Texture; unit: number } {
  let largest = 0;
  for (const { lobes } of solution.patches) {
    for (const value of lobes?.z ?? []) largest = Math.max(largest, Math.abs(value));
  }
  const scale = precision === 'half' ? halfScale(largest) : 1;
  const rows = Math.max(1, Math.ceil(layout.coefficientCount / kSide));
  const height = Math.min(kSide, rows), layers = Math.ceil(rows / height);
  const texels = new Float32Array(3);
  const size = kSide * height * layers * 3;
  const data = precision === 'half' ? new Uint16Array(size) : new Float32Array(size);
  for (const { patch, firstCoefficient, coefficientsOfNode: K } of layout.patches) {
    if (!patch.lobes) continue;
    const { z } = patch.lobes;
    for (let node = 0; node < z.length / (3 * K); ++node) {
      for (let k = 0; k < K; ++k) {
        for (let c = 0; c < 3; ++c) texels[c] = z[(3 * node + c) * K + k];
        const at = 3 * (firstCoefficient + node * K + k);
        if (data instanceof Uint16Array) toHalves(texels, scale, data, at);
        else data.set(texels, at);
      }
    }
  }
  const texture = new DataArrayTexture(data as never, kSide, height, layers);
  texture.format = RGBFormat as never;
  texture.type = precision === 'half' ? HalfFloatType : FloatType;
  texture.internalFormat = precision === 'half' ? 'RGB16F' : 'RGB32F';
  return { texture: asTable(texture), unit: 1 / scale };
}

function tableTexture(layout: Layout): Texture {
  const rows = Math.max(1, Math.ceil((layout.nodeCount - layout.flatCount) / kNodesInRow));
  // Integers may not go through floats: as those they are denormal, and GPUs make 0 of them.
  const data = new Uint32Array(kSide * rows * 4), floats = new Float32Array(data.buffer);
  for (const { patch, firstSlot, firstCoefficient, coefficientsOfNode } of layout.patches) {
    if (firstSlot < layout.flatCount || !patch.lobes) continue;
    for (let i = 0; i < patch.positions.length / 3; ++i) {
      const at = 8 * (firstSlot - layout.flatCount + i);
      floats.set(patch.positions.subarray(3 * i, 3 * i + 3), at);
      data[at + 3] = firstCoefficient + i * coefficientsOfNode;
      floats.set(patch.normals.subarray(3 * i, 3 * i + 3), at + 4);
      data[at + 7] = patch.lobes.lMax;
    }
  }
  const texture = new DataTexture(data, kSide, rows, RGBAIntegerFormat, UnsignedIntType);
  texture.internalFormat = 'RGBA32UI';
  return asTable(texture);
}

function stepTexture(): Texture {
  const columns = Math.floor(kMostDegree / 2) + 1, rows = kMostDegree + 1;
  const data = new Float32Array(4 * columns * rows);
  for (let m = 0; m < rows; ++m) {
    for (let j = 0; j < columns; ++j) {
      const { a, b, c } = zernikeStep(m, j);
      data.set([a, b, c, zernikeScale(m + 2 * j, m)], 4 * (m * columns + j));
    }
  }
  return asTable(new DataTexture(data, columns, rows, RGBAFormat, FloatType));
}

export const lobeGlsl = /* glsl */ `
uniform highp sampler2DArray coefficients;
uniform highp usampler2D table;
uniform highp sampler2D steps;
uniform float coefficientUnit;
uniform int degree;

vec3 coefficientAt(int i) {
  return texelFetch(coefficients, ivec3(i & 2047, (i >> 11) & 2047, i >> 22), 0).rgb;
}

// Sum of the lobe's terms of degree up to l, by the recurrence of sh/zernike.ts; and its derivatives by x and y of the
// disc, the recurrence's own derivative by u going along.
vec3 lobeOf(int first, int l, vec2 at, out vec3 alongX, out vec3 alongY) {
  float u = 2.0 * dot(at, at) - 1.0;
  vec2 turn = vec2(1.0, 0.0), turnBefore = vec2(0.0);  // (x + i y)^m
  vec3 sum = vec3(0.0);
  alongX = alongY = vec3(0.0);
  for (int m = 0; m <= l; ++m) {
    float before = 0.0, here = 1.0, slopeBefore = 0.0, slope = 0.0;
    vec3 even = vec3(0.0), odd = vec3(0.0), evenSlope = vec3(0.0), oddSlope = vec3(0.0);
    for (int n = m, j = 0; n <= l; n += 2, ++j) {
      vec4 step = texelFetch(steps, ivec2(j, m), 0);
      int k = first + (n * (n + 1)) / 2 + (n + m) / 2;
      vec3 c = coefficientAt(k) * step.w;
      even += here * c;
      evenSlope += slope * c;
      if (m > 0) {
        c = coefficientAt(k - m) * step.w;
        odd += here * c;
        oddSlope += slope * c;
      }
      float factor = step.x * u + step.y;
      float next = factor * here - step.z * before, slopeNext = step.x * here + factor * slope - step.z * slopeBefore;
      before = here;
      here = next;
      slopeBefore = slope;
      slope = slopeNext;
    }
    sum += turn.x * even + turn.y * odd;
    vec3 bySquare = 4.0 * (turn.x * evenSlope + turn.y * oddSlope);  // du/dx = 4 x
    alongX += float(m) * (turnBefore.x * even + turnBefore.y * odd) + at.x * bySquare;
    alongY += float(m) * (turnBefore.x * odd - turnBefore.y * even) + at.y * bySquare;
    turnBefore = turn;
    turn = vec2(turn.x * at.x - turn.y * at.y, turn.x * at.y + turn.y * at.x);
  }
  alongX *= coefficientUnit;
  alongY *= coefficientUnit;
  return sum * coefficientUnit;
}
`;
