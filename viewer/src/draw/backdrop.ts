/** What is drawn without lobes: the black that no patch covers, depths alone, wires. */
import {
  BackSide, BufferAttribute, BufferGeometry, DoubleSide, FrontSide, GLSL3, NoBlending, RawShaderMaterial, Vector4,
} from 'three';
import type { Faces, Material } from '../solution/solution';
import { emissionGlsl } from './emission';
import type { PatchUniforms } from './surfaces';

/** Brighter light is cut here: halves end at 65504, and sums of samples have to stay below. */
export const kBrightest = 60000;

/** The input's triangles but glass, each with what its material emits in front and behind. */
export function faceGeometry(faces: Faces, materials: readonly Material[]): BufferGeometry {
  const kept: number[] = [];
  for (let f = 0; f < faces.indices.length / 3; ++f) if (!materials[faces.material[f]].transmission) kept.push(f);
  const positions = new Float32Array(9 * kept.length), rows = new Float32Array(3 * kept.length);
  kept.forEach((f, at) => {
    for (let k = 0; k < 3; ++k) {
      const v = 3 * faces.indices[3 * f + k];
      positions.set(faces.positions.subarray(v, v + 3), 9 * at + 3 * k);
      rows[3 * at + k] = 2 * faces.material[f];
    }
  });
  const geometry = new BufferGeometry();
  geometry.setAttribute('position', new BufferAttribute(positions, 3));
  geometry.setAttribute('row', new BufferAttribute(rows, 1));
  return geometry;
}

/** A hair behind what lies in the same plane: one step of slope, and a few of depth. */
const behind = { polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 4 };

export function backdropMaterial(shared: PatchUniforms): RawShaderMaterial {
  return new RawShaderMaterial({
    glslVersion: GLSL3, side: DoubleSide, blending: NoBlending, ...behind,
    uniforms: {
      emission: shared.emission, unit: shared.unit, seeThrough: { value: false }, numbers: { value: false },
      mirrorPlane: { value: new Vector4(0, 0, 0, 1e30) },
    },
    vertexShader: /* glsl */ `
      precision highp float;
      precision highp int;
      uniform mat4 modelViewMatrix, projectionMatrix;
      in vec3 position;
      in float row;
      flat out int emitter;
      #ifdef MIRROR_SLACK
        uniform vec4 mirrorPlane;
        out float toMirror;
      #endif
      void main() {
        emitter = int(row);
        #ifdef MIRROR_SLACK
          toMirror = dot(mirrorPlane, vec4(position, 1.0));
        #endif
        gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
      }`,
    fragmentShader: /* glsl */ `
      precision highp float;
      precision highp int;
      ${emissionGlsl}
      uniform float unit;
      uniform bool seeThrough, numbers;
      flat in int emitter;
      #ifdef MIRROR_SLACK
        in float toMirror;
      #endif
      out vec4 pixel;
      void main() {
        vec3 emitted = emissionOf(emitter + (gl_FrontFacing ? 0 : 1));
        bool black = emitted == vec3(0.0);
        if (seeThrough && black && !gl_FrontFacing) discard;
        #ifdef MIRROR_SLACK
          if (!gl_FrontFacing && abs(toMirror) < MIRROR_SLACK) discard;
        #endif
        pixel = vec4(numbers ? vec3(0.0) : min(emitted * unit, ${kBrightest}.0), 1.0);
      }`,
  });
}

export function backsMaterial(): RawShaderMaterial {
  return new RawShaderMaterial({
    glslVersion: GLSL3, side: BackSide, blending: NoBlending, ...behind,
    vertexShader: depthVertex, fragmentShader: 'precision highp float;\nout vec4 pixel;\nvoid main() { pixel = vec4(0.0); }',
  });
}

const depthVertex = /* glsl */ `
precision highp float;
uniform mat4 modelViewMatrix, projectionMatrix;
in vec3 position;
void main() { gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0); }
`;

export function depthMaterial(side: typeof FrontSide | typeof DoubleSide): RawShaderMaterial {
  return new RawShaderMaterial({
    glslVersion: GLSL3, side, colorWrite: false, ...(side === DoubleSide ? behind : {}),
    uniforms: side === DoubleSide ? { seeThrough: { value: false } } : {},
    vertexShader: depthVertex,
    fragmentShader: /* glsl */ `
      precision highp float;
      ${side === DoubleSide ? 'uniform bool seeThrough;' : 'const bool seeThrough = false;'}
      out vec4 pixel;
      void main() {
        if (seeThrough && !gl_FrontFacing) discard;
        pixel = vec4(0.0);
      }`,
  });
}

export function wireMaterial(): RawShaderMaterial {
  return new RawShaderMaterial({
    glslVersion: GLSL3, transparent: true, depthWrite: false,
    vertexShader: /* glsl */ `
      precision highp float;
      uniform mat4 modelViewMatrix, projectionMatrix;
      uniform vec3 cameraPosition;
      in vec3 position;
      in vec4 normal;
      out float facing;
      void main() {
        facing = dot(normal.xyz, cameraPosition - position);
        vec4 seen = modelViewMatrix * vec4(position, 1.0);
        seen.xyz *= 0.999;  // towards the eye by a thousandth of the way: before its own element
        gl_Position = projectionMatrix * seen;
      }`,
    fragmentShader: /* glsl */ `
      precision highp float;
      in float facing;
      out vec4 pixel;
      void main() {
        if (facing <= 0.0) discard;
        pixel = vec4(0.55, 0.75, 0.95, 0.35);
      }`,
  });
}
