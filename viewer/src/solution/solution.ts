/**
 * A solution as the rest of the viewer knows it: what docs/format.md says, read and checked. Lobes are over Zernike's
 * basis (sh/zernike.ts), base and gloss added.
 */
import type { Matrix4 } from 'three';

export type Rgb = [number, number, number];
export type Side = 'front' | 'back';

/** Beyond what any solve makes; a larger number is damage. */
export const kMostDegree = 64;

/** How the gloss of a material is held: none; a lobe; a lobe that blurs it, so renderers gather it; ideal mirror. */
export type GlossKind = 'none' | 'lobe' | 'sharp' | 'mirror';

/** What Fresnel's factor of an ideal mirror or of clear glass needs: Schlick's law from f0 to f90. */
export interface Specular {
  f0: Rgb;
  f90: Rgb;
}

export interface Material {
  name: string;
  kind: GlossKind;
  /** Flux-weighted relative error of its lobes. */
  error: number;
  /** Radiance, W m⁻² sr⁻¹, of fronts, and of backs too if doubleSided. */
  emission: Rgb;
  doubleSided: boolean;
  /** Hemispherical albedo; null if the file does not say. */
  albedo: Rgb | null;
  /** Of kind "mirror", and of glass. */
  specular: Specular;
  /** The share of light that goes straight through under Fresnel's factor; null: not glass. */
  transmission: Rgb | null;
  /** What a body of glass takes from light inside it, per metre: light falls as exp(-extinction · length). Zero: clear,
   *  or a pane. */
  extinction: Rgb;
}

/** The lobes of a patch's nodes: radiance reflected towards ω is Σ_k z_k Z_k(ω). */
export interface Lobes {
  lMax: number;
  /** Coefficient k of channel c of node i: [(i · 3 + c) · coefficientCount(lMax) + k]. */
  z: Float32Array;
}

/** A connected piece of one surface, one side, one material (format.md#1). */
export interface Patch {
  index: number;
  material: number;
  /** Index into Solution.surfaceNames. */
  surface: number;
  side: Side;
  /** All its normals are one. */
  planar: boolean;
  /** Number of its first node as `lobe inspect --node` counts. */
  firstNode: number;
  /** Three floats a node: metres; unit shading normals, on the patch's side. */
  positions: Float32Array;
  normals: Float32Array;
  /** Three nodes of this patch (from 0) an element, counter-clockwise. */
  indices: Uint32Array;
  /** Per node: 1, inside something, without weight. Null: none is. */
  hidden: Uint8Array | null;
  /** Null: black. */
  lobes: Lobes | null;
}

/** The triangles that the scene's file holds; what no patch covers is black, or glass. */
export interface Faces {
  positions: Float32Array;
  normals: Float32Array;
  indices: Uint32Array;
  /** Per triangle. */
  material: ArrayLike<number>;
}

export interface NamedCamera {
  name: string;
  /** Columns: right, up, back, eye. */
  matrix: Matrix4;
  /** Vertical, radians. */
  fovY: number;
}

export interface Solution {
  /** The file's name, for people. */
  title: string;
  materials: Material[];
  surfaceNames: string[];
  patches: Patch[];
  /** Null in files that do not hold them. */
  faces: Faces | null;
  cameras: NamedCamera[];
  nodeCount: number;
  elementCount: number;
  /** Radiance times this shows most of the scene below 1. */
  exposureScale: number;
  /** Why its light is not to be trusted, or not all there; empty if it is. */
  trust: string;
}

/** Of a node of the whole solution: its patch, and its number there. */
export function findNode(solution: Solution, node: number): { patch: Patch; local: number } | null {
  for (const patch of solution.patches) {
    const local = node - patch.firstNode;
    if (local >= 0 && local < patch.positions.length / 3) return { patch, local };
  }
  return null;
}
