/**
 * Everything opaque that is no mirror: the patches in two draw calls, flat and glossy, and behind them the input's
 * faces, black but for what they emit (docs/conventions.md#sides).
 *
 * Light is stored in units that make most of the scene about 1 (`unit`), so that half floats hold it well whatever
 * the lamps.
 */
import {
  BufferAttribute, BufferGeometry, DoubleSide, FrontSide, GLSL3, LineSegments, Mesh, NoBlending, RawShaderMaterial, Vector2,
  type IUniform, type Texture,
} from 'three';
import type { Solution } from '../solution/solution';
import { backdropMaterial, backsMaterial, depthMaterial, faceGeometry, kBrightest, wireMaterial } from './backdrop';
import { categories, colourTexture, falseColourGlsl } from './colour_map';
import { emissionGlsl, emissionTexture } from './emission';
import { edgesOf, elementsOf, isFlat, type Layout, type PlacedPatch } from './layout';
import { kNodesInRow } from './lobe_textures';
import { srgbGlsl } from './tone';

/** What all shaders of patches read. */
export interface PatchUniforms extends Record<string, IUniform> {
  coefficients: IUniform;
  coefficientUnit: IUniform;
  /** Of NodeLight, by channel. */
  redOfNodes: IUniform;
  greenOfNodes: IUniform;
  blueOfNodes: IUniform;
  emission: IUniform;
  flatCount: IUniform;
  unit: IUniform;
}

/**
 * Corners of elements: light and weight of the node, what its material emits. With `glossy`, for patches whose light
 * depends on the eye; without, for flat ones, which need none of that. `more` goes into main.
 */
const patchVertex = (glossy: boolean, declarations: string, more: string) => /* glsl */ `
precision highp float;
precision highp int;
uniform mat4 modelViewMatrix, projectionMatrix;
uniform highp sampler2DArray coefficients;
uniform highp sampler2D redOfNodes, greenOfNodes, blueOfNodes;
uniform float coefficientUnit;
uniform int flatCount;
in vec3 position;
in vec2 state;                // emitter; 1: not hidden
centroid out vec4 light;      // radiance, 1; times the node's weight
flat out vec3 emitted;
${glossy ? 'centroid out vec3 at, redSlope, greenSlope, blueSlope;' : ''}
${emissionGlsl}
${declarations}
void main() {
  int slot = gl_VertexID;
  ${glossy ? `
  int i = slot - flatCount;
  ivec2 texel = ivec2(i % ${kNodesInRow}, i / ${kNodesInRow});
  vec4 red = texelFetch(redOfNodes, texel, 0), green = texelFetch(greenOfNodes, texel, 0), blue = texelFetch(blueOfNodes, texel, 0);
  vec3 radiance = vec3(red.a, green.a, blue.a);
  redSlope = red.rgb * state.y;
  greenSlope = green.rgb * state.y;
  blueSlope = blue.rgb * state.y;
  at = position;` : `
  vec3 radiance = texelFetch(coefficients, ivec3(slot & 2047, (slot >> 11) & 2047, slot >> 22), 0).rgb *
                  (coefficientUnit * ${Math.sqrt(1 / Math.PI)});  // Z_00`}
  light = vec4(radiance, 1.0) * state.y;
  emitted = emissionOf(int(state.x));
  gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
  ${more}
}
`;

/** `leaving()`: radiance of the surface itself. Hidden nodes have no weight; the negative is shown as 0. */
const patchFragment = (glossy: boolean) => /* glsl */ `
precision highp float;
precision highp int;
uniform float unit;
uniform vec3 cameraPosition;
centroid in vec4 light;
flat in vec3 emitted;
${glossy ? 'centroid in vec3 at, redSlope, greenSlope, blueSlope;' : ''}
out vec4 pixel;
vec3 leaving() {
  vec3 reflected = light.rgb;
  ${glossy ? `
  vec3 wo = normalize(cameraPosition - at);
  reflected += vec3(dot(redSlope, wo), dot(greenSlope, wo), dot(blueSlope, wo));` : ''}
  return (light.a > 1e-6 ? max(reflected / light.a, 0.0) : vec3(0.0)) + emitted;
}
vec3 stored(vec3 radiance) { return min(radiance * unit, ${kBrightest}.0); }
`;

export const plainMain = 'void main() { pixel = vec4(stored(leaving()), 1.0); }';

export class Surfaces {
  readonly uniforms: PatchUniforms;
  /** Flat ones, glossy ones. */
  readonly patches: Mesh[];
  readonly backdrop: Mesh;
  /** Their depths alone, where the overlay is drawn. */
  readonly depths: Mesh[];
  private readonly attributes: Record<string, BufferAttribute>;
  private readonly geometries: BufferGeometry[] = [];
  private falseColours: RawShaderMaterial | null = null;
  private readonly scales = new Map<string, Texture>();
  private edges: LineSegments | null = null;

  constructor(
    solution: Solution, private readonly layout: Layout, shared: Pick<PatchUniforms, 'coefficients' | 'coefficientUnit'>,
    nodeLight: readonly Texture[], unit: number, opaque: readonly PlacedPatch[],
  ) {
    const positions = new Float32Array(3 * layout.nodeCount), states = new Float32Array(2 * layout.nodeCount);
    for (const { patch, firstSlot } of layout.patches) {
      positions.set(patch.positions, 3 * firstSlot);
      for (let i = 0; i < patch.positions.length / 3; ++i) {
        states[2 * (firstSlot + i)] = 2 * patch.material + (patch.side === 'back' ? 1 : 0);
        states[2 * (firstSlot + i) + 1] = patch.hidden?.[i] ? 0 : 1;
      }
    }
    this.attributes = { position: new BufferAttribute(positions, 3), state: new BufferAttribute(states, 2) };
    this.uniforms = {
      ...shared,
      redOfNodes: { value: nodeLight[0] },
      greenOfNodes: { value: nodeLight[1] },
      blueOfNodes: { value: nodeLight[2] },
      emission: { value: emissionTexture(solution.materials) },
      flatCount: { value: layout.flatCount },
      unit: { value: unit },
    };
    this.patches = [true, false].map((flat) => {
      const mesh = asMesh(
        this.geometry(elementsOf(opaque.filter((p) => isFlat(p.patch) === flat))), this.patchMaterial(!flat, plainMain));
      mesh.userData.light = mesh.material;
      return mesh;
    });
    const { faces } = solution;
    this.backdrop = faces
      ? asMesh(this.keep(faceGeometry(faces, solution.materials)), backdropMaterial(this.uniforms))
      // Not all of what is black, but the backs of what is lit.
      : asMesh(this.geometry(elementsOf(opaque)), backsMaterial());
    const inFront = depthMaterial(FrontSide);
    this.depths = [
      asMesh(this.backdrop.geometry, depthMaterial(DoubleSide)),
      ...this.patches.map((mesh) => asMesh(mesh.geometry, inFront)),
    ];
    this.seeThrough(false);
  }

  /** A geometry over the buffers that all patches share. */
  geometry(elements: Uint32Array): BufferGeometry {
    const geometry = new BufferGeometry();
    for (const [name, attribute] of Object.entries(this.attributes)) geometry.setAttribute(name, attribute);
    geometry.setIndex(new BufferAttribute(elements, 1));
    return this.keep(geometry);
  }

  /** An attribute for every node, in the order of slots: false colours' numbers, mirrors' normals. */
  setAttribute(name: string, attribute: BufferAttribute): void {
    this.attributes[name] = attribute;
    for (const geometry of this.geometries) if (geometry.getAttribute('state')) geometry.setAttribute(name, attribute);
  }

  /** Backs without light let look into rooms from outside, or not. */
  seeThrough(backs: boolean): void {
    for (const mesh of [this.backdrop, this.depths[0]]) {
      const material = mesh.material as RawShaderMaterial;
      if (material.uniforms.seeThrough) material.uniforms.seeThrough.value = backs;
      else mesh.visible = !backs;
    }
  }

  /** From now on the eye behind a mirror (`mirrorPlane`) looks through the mirror's own black back: through backs less
   *  than `slack` metres from the plane. */
  letMirrorsThrough(slack: number): void {
    const material = this.backdrop.material as RawShaderMaterial;
    if (!material.uniforms.mirrorPlane) return;
    material.defines.MIRROR_SLACK = slack.toExponential();
    material.needsUpdate = true;
  }

  /** Numbers by slot in place of light; null: light. */
  showNumbers(values: Float32Array | null): void {
    for (const mesh of this.patches) {
      mesh.material = values ? this.numberMaterial() : (mesh.userData.light as RawShaderMaterial);
    }
    const backs = (this.backdrop.material as RawShaderMaterial).uniforms.numbers;
    if (backs) backs.value = values !== null;
    if (values) this.setAttribute('number', new BufferAttribute(values, 1));
  }

  setScale(quantity: string, low: number, high: number, logarithmic: boolean): void {
    const u = this.numberMaterial().uniforms;
    const kinds = quantity === 'kind' || quantity === 'hidden' ? categories[quantity] : null;
    const key = kinds ? quantity : '';
    if (!this.scales.has(key)) this.scales.set(key, colourTexture(kinds));
    u.colours.value = this.scales.get(key);
    u.kinds.value = kinds?.length ?? 0;
    (u.scale.value as Vector2).set(low, high);
    u.logarithmic.value = logarithmic;
  }

  /** Material of patches in false colours: what it writes are colours of the display, decoded. */
  numberMaterial(): RawShaderMaterial {
    return (this.falseColours ??= this.patchMaterial(false, /* glsl */ `
      centroid in float shownNumber;
      ${falseColourGlsl} ${srgbGlsl}
      void main() { pixel = vec4(decodeSrgb(falseColour(shownNumber)), 1.0); }`,
      'in float number;\ncentroid out float shownNumber;', 'shownNumber = number;',
      { colours: { value: null }, scale: { value: new Vector2(0, 1) }, logarithmic: { value: false }, kinds: { value: 0 } }));
  }

  /** Thin lines on the elements' edges, drawn over the picture. Made when first asked for. */
  wires(): LineSegments {
    if (this.edges) return this.edges;
    const geometry = this.keep(new BufferGeometry());
    const normals = new Int8Array(4 * this.layout.nodeCount);
    for (const { patch, firstSlot } of this.layout.patches) {
      for (let i = 0; i < patch.normals.length / 3; ++i) {
        for (let c = 0; c < 3; ++c) normals[4 * (firstSlot + i) + c] = Math.round(127 * patch.normals[3 * i + c]);
      }
    }
    geometry.setAttribute('position', this.attributes.position);
    geometry.setAttribute('normal', new BufferAttribute(normals, 4, true));
    geometry.setIndex(new BufferAttribute(edgesOf(elementsOf(this.layout.patches), this.layout.nodeCount), 1));
    this.edges = new LineSegments(geometry, wireMaterial());
    this.edges.frustumCulled = false;
    return this.edges;
  }

  /** `main` writes `pixel`, with the help of `leaving()` and `stored()`. */
  patchMaterial(
    glossy: boolean, main: string, declarations = '', more = '', uniforms: Record<string, IUniform> = {},
  ): RawShaderMaterial {
    return new RawShaderMaterial({
      glslVersion: GLSL3, side: FrontSide, blending: NoBlending, uniforms: { ...this.uniforms, ...uniforms },
      vertexShader: patchVertex(glossy, declarations, more), fragmentShader: patchFragment(glossy) + main,
    });
  }

  private keep(geometry: BufferGeometry): BufferGeometry {
    this.geometries.push(geometry);
    return geometry;
  }
}

export function asMesh(geometry: BufferGeometry, material: RawShaderMaterial): Mesh {
  const mesh = new Mesh(geometry, material);
  mesh.frustumCulled = false;
  return mesh;
}
