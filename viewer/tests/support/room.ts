import { DataUtils } from 'three';
import { coefficientCount } from '../../src/sh/zernike';
import { Glb } from './glb';

/** The coefficients that `room` gives part `part` of patch `patch`: generic, and different everywhere. */
export function coefficients(patch: number, part: 'base' | 'gloss', lMax: number, nodes: number): Float32Array {
  const phase = 7 * patch + (part === 'base' ? 0 : 3);
  return Float32Array.from({ length: nodes * 3 * coefficientCount(lMax) }, (_, i) => Math.sin(1.3 * i + phase) + 0.5);
}

interface RoomOptions {
  /** As `lobe export --half` writes: lobes as half floats times this power of two, and no faces. */
  halfScale?: number;
}

export const kFloorDegrees = { lMaxBase: 1, lMaxGloss: 4 };

/**
 * A solution of three patches. Patch 0: a glossy floor, four nodes, two elements, base and gloss of different degrees.
 * Patch 1: a diffuse wall, three nodes, the second hidden. Patch 2: a lamp that reflects nothing.
 */
export function room({ halfScale }: RoomOptions = {}): Glb {
  const glb = new Glb();
  const vec3 = (...values: number[]) => glb.accessor(Float32Array.from(values), 'VEC3');
  const repeat = (count: number, ...v: number[]) => vec3(...Array.from({ length: count }, () => v).flat());
  const indices = (...values: number[]) => glb.accessor(Uint32Array.from(values));
  const lobes = (patch: number, part: 'base' | 'gloss', lMax: number, nodes: number): object => {
    const values = coefficients(patch, part, lMax, nodes);
    if (halfScale === undefined) return { [part]: glb.accessor(values) };
    const halves = Uint16Array.from(values, (v) => DataUtils.toHalfFloat(v / halfScale));
    return { [part]: glb.accessor(halves), [`${part}Scale`]: halfScale };
  };
  const primitive = (extension: object, at: number[], normal: number[], elements: number[], baked: number[]) => ({
    attributes: {
      POSITION: vec3(...at), NORMAL: repeat(at.length / 3, ...normal), COLOR_0: repeat(at.length / 3, ...baked),
    },
    indices: indices(...elements),
    material: 3,
    extensions: { LOBE_directional_radiance: extension },
  });

  const floor = primitive(
    { patch: 0, material: 1, surface: 0, side: 'front', planar: true, ...kFloorDegrees,
      ...lobes(0, 'base', kFloorDegrees.lMaxBase, 4), ...lobes(0, 'gloss', kFloorDegrees.lMaxGloss, 4) },
    [0, 0, 0, 0, 0, 1, 1, 0, 1, 1, 0, 0], [0, 1, 0], [0, 1, 2, 0, 2, 3], [0.25, 0.5, 0.75]);
  const wall = primitive(
    { patch: 1, material: 0, surface: 1, side: 'back', lMaxBase: 0,
      hidden: glb.accessor(Uint8Array.of(0, 1, 0)), ...lobes(1, 'base', 0, 3) },
    [0, 0, 0, 1, 0, 0, 0, 1, 0], [0, 0, 1], [0, 1, 2], [0.5, 0.5, 0.5]);
  const lamp = primitive(
    { patch: 2, material: 2, surface: 2, side: 'front' },
    [0, 1, 0, 1, 1, 0, 0, 1, 1], [0, -1, 0], [0, 1, 2], [1, 1, 1]);

  Object.assign(glb.json, {
    extensionsUsed: ['LOBE_directional_radiance', 'KHR_materials_unlit'],
    // Not in the order of their patches.
    meshes: [{ primitives: [wall] }, { primitives: [floor, lamp] }],
    nodes: [
      { mesh: 0 }, { mesh: 1 },
      { name: 'view0', camera: 0, matrix: [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0.5, 0.25, 3, 1] },
    ],
    scenes: [{ nodes: [0, 1, 2] }],
    scene: 0,
    cameras: [{ type: 'perspective', perspective: { yfov: 0.75, aspectRatio: 1.5, znear: 0.01 } }],
    materials: [
      { name: 'chalk', pbrMetallicRoughness: { baseColorFactor: [0.5, 0.25, 0.125, 1], metallicFactor: 0 } },
      { name: 'lacquer', pbrMetallicRoughness: { metallicFactor: 0, roughnessFactor: 0.3 } },
      { name: 'lamp', doubleSided: true, emissiveFactor: [1, 0.5, 0.25],
        extensions: { KHR_materials_emissive_strength: { emissiveStrength: 12 } } },
      { extensions: { KHR_materials_unlit: {} } },
    ],
    extensions: {
      LOBE_directional_radiance: {
        version: 1, basis: 'H', frame: 'duff2017', exposureScale: 2,
        surfaceNames: ['floor', 'wall', 'lamp'],
        materials: [{ kind: 'none', error: 0 }, { kind: 'lobe', error: 0.0625 }, { kind: 'none', error: 0 }],
        ...(halfScale === undefined
          ? { faces: {
              positions: vec3(0, 0, 0, 0, 0, 1, 1, 0, 1, 1, 0, 0), normals: repeat(4, 0, 1, 0),
              indices: indices(0, 1, 2, 0, 2, 3), material: glb.accessor(Uint8Array.of(1, 1)),
              surface: glb.accessor(Uint8Array.of(0, 0)) } }
          : { viewing: true }),
      },
    },
  });
  return glb;
}
