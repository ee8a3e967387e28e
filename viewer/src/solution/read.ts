/** Reads LOBE_directional_radiance (docs/format.md) of a glTF that three's GLTFLoader has parsed. */
import { DataUtils, InterleavedBufferAttribute, Matrix4, type BufferAttribute } from 'three';
import { coefficientCount, toZernike } from '../sh/zernike';
import { readMaterial, type GltfMaterial, type LobeMaterial } from './material';
import { Problem } from './problem';
import { trustOf, type TrustRecord } from './trust';
import { kMostDegree, type Faces, type Lobes, type NamedCamera, type Patch, type Side, type Solution } from './solution';

export const kExtension = 'LOBE_directional_radiance';
const kVersion = 1;

interface DocumentExtension extends TrustRecord {
  version?: number;
  basis?: string;
  frame?: string;
  materials?: LobeMaterial[];
  surfaceNames?: string[];
  exposureScale?: number;
  faces?: { positions: number; normals: number; indices: number; material: number };
}

interface PrimitiveExtension {
  patch?: number;
  material?: number;
  surface?: number;
  side?: string;
  planar?: boolean;
  hidden?: number;
  lMaxBase?: number;
  lMaxGloss?: number;
  base?: number;
  gloss?: number;
  baseScale?: number;
  glossScale?: number;
}

interface Primitive {
  attributes: Record<string, number>;
  indices?: number;
  extensions?: Record<string, PrimitiveExtension>;
}

export interface Document {
  accessors?: object[];
  extensions?: Record<string, DocumentExtension>;
  materials?: GltfMaterial[];
  meshes?: { primitives: Primitive[] }[];
  nodes?: { name?: string; camera?: number; matrix?: number[] }[];
  cameras?: { name?: string; perspective?: { yfov: number; aspectRatio?: number } }[];
}

/** What of GLTFLoader's parser is used: its JSON, and accessors by index. */
export interface Parser {
  json: Document;
  getDependency(type: 'accessor', index: number): Promise<BufferAttribute>;
}

type Numbers = Float32Array | Uint32Array | Uint16Array | Uint8Array;

/** Says whether a file is a solution that can be read here; throws Problem if it is not. */
export function checkDocument(json: Document): DocumentExtension {
  const extension = json.extensions?.[kExtension];
  if (!extension) {
    throw new Problem(
      'is a glTF file without lobes; expected one that `lobe solve` or `lobe export` wrote ' +
        `(its ${kExtension} is missing)`,
    );
  }
  if (extension.version !== kVersion) {
    throw new Problem(
      `is of format version ${extension.version}, and this viewer reads version ${kVersion}; ` +
        'a newer Lobe has a viewer for it',
    );
  }
  if (extension.basis !== 'H' || extension.frame !== 'duff2017') {
    throw new Problem(`has basis "${extension.basis}" and frame "${extension.frame}", expected "H" and "duff2017"`);
  }
  for (const member of ['materials', 'surfaceNames'] as const) {
    if (!Array.isArray(extension[member])) throw new Problem(`has no list "${member}" in its ${kExtension}`);
  }
  return extension;
}

const isIndex = (value: unknown, count: number): value is number =>
  Number.isInteger(value) && (value as number) >= 0 && (value as number) < count;

const isFinitePositive = (value: unknown): value is number => Number.isFinite(value) && (value as number) > 0;

/** The loader hands out the whole bufferView of what lies interleaved with something else. */
function deinterleave(attribute: InterleavedBufferAttribute): ArrayLike<number> {
  const { array, stride } = attribute.data;
  const out = new (array.constructor as typeof Float32Array)(attribute.count * attribute.itemSize);
  for (let i = 0; i < attribute.count; ++i) {
    for (let k = 0; k < attribute.itemSize; ++k) {
      out[i * attribute.itemSize + k] = array[i * stride + attribute.offset + k];
    }
  }
  return out;
}

/** An accessor's numbers: `count` of them, if given, of `components` each. */
async function numbers(
  parser: Parser, what: string, accessor: number | undefined, components: number, count?: number,
): Promise<Numbers> {
  if (accessor === undefined) throw new Problem(`${what} is missing`);
  const accessors = parser.json.accessors?.length ?? 0;
  if (!isIndex(accessor, accessors)) throw new Problem(`${what} is accessor ${accessor}, expected below ${accessors}`);
  const attribute = await parser.getDependency('accessor', accessor);
  if (!attribute || attribute.itemSize !== components || (count !== undefined && attribute.count !== count)) {
    throw new Problem(
      `${what} has ${attribute?.count ?? 0} entries of ${attribute?.itemSize ?? 0} numbers, ` +
        `expected ${count ?? 'some'} of ${components}`,
    );
  }
  return (attribute instanceof InterleavedBufferAttribute ? deinterleave(attribute) : attribute.array) as Numbers;
}

/** One look at everything: a NaN would blacken the page without a word. Doubles hold the sum of any floats. */
function allFinite(values: Float32Array): boolean {
  let sum = 0;
  for (let i = 0; i < values.length; ++i) sum += Math.abs(values[i]);
  return Number.isFinite(sum);
}

async function floats(
  parser: Parser, what: string, accessor: number | undefined, components: number, count?: number,
): Promise<Float32Array> {
  const array = await numbers(parser, what, accessor, components, count);
  if (!(array instanceof Float32Array)) throw new Problem(`${what} does not hold floats`);
  if (!allFinite(array)) throw new Problem(`${what} holds a value that is not a number`);
  return array;
}

function checkIndices(what: string, indices: Numbers, count: number): Uint32Array {
  if (indices instanceof Float32Array) throw new Problem(`${what} holds floats, expected whole numbers`);
  const out = indices instanceof Uint32Array ? indices : Uint32Array.from(indices);
  const wrong = out.findIndex((i) => i >= count);
  if (wrong >= 0) throw new Problem(`${what} has index ${out[wrong]}, expected below ${count}`);
  if (out.length % 3 !== 0) throw new Problem(`${what} has ${out.length} indices, expected a multiple of 3`);
  return out;
}

/** One part of a primitive's lobes, over H: coefficient k of channel c of node i at [(3 i + c) K + k]. */
async function readPart(
  parser: Parser, what: string, lMax: number, accessor: number | undefined, scale: number | undefined, nodes: number,
): Promise<{ lMax: number; h: Float32Array }> {
  if (!Number.isInteger(lMax) || lMax < 0 || lMax > kMostDegree) {
    throw new Problem(`${what} is of degree ${lMax}, expected 0 to ${kMostDegree}`);
  }
  const raw = await numbers(parser, what, accessor, 1, nodes * 3 * coefficientCount(lMax));
  let h: Float32Array;
  if (raw instanceof Float32Array) {
    h = raw;
  } else if (raw instanceof Uint16Array) {
    // IEEE half precision, times a power of two of the primitive's own.
    const factor = scale ?? 1;
    if (!isFinitePositive(factor)) throw new Problem(`${what} has scale ${factor}, expected a positive number`);
    h = Float32Array.from(raw, (bits) => DataUtils.fromHalfFloat(bits) * factor);
  } else {
    throw new Problem(`${what} holds neither floats nor half floats`);
  }
  if (!allFinite(h)) throw new Problem(`${what} holds a coefficient that is not a number`);
  return { lMax, h };
}

/** Both parts added, over Zernike's basis; null if both are black. */
async function readLobes(parser: Parser, what: string, e: PrimitiveExtension, nodes: number): Promise<Lobes | null> {
  const parts: { lMax: number; h: Float32Array }[] = [];
  if (e.lMaxBase !== undefined) {
    parts.push(await readPart(parser, `${what}'s base`, e.lMaxBase, e.base, e.baseScale, nodes));
  }
  if (e.lMaxGloss !== undefined) {
    parts.push(await readPart(parser, `${what}'s gloss`, e.lMaxGloss, e.gloss, e.glossScale, nodes));
  }
  if (parts.length === 0) return null;
  const lMax = Math.max(...parts.map((p) => p.lMax));
  const K = coefficientCount(lMax);
  const z = new Float32Array(nodes * 3 * K);
  const channel = new Float64Array(K);
  for (const part of parts) {
    const k = coefficientCount(part.lMax);
    for (let row = 0; row < nodes * 3; ++row) {
      toZernike(part.lMax, part.h.subarray(row * k, (row + 1) * k), channel);
      for (let i = 0; i < k; ++i) z[row * K + i] += channel[i];
    }
  }
  return { lMax, z };
}

async function readPatch(parser: Parser, primitive: Primitive, surfaces: number, materials: number): Promise<Patch> {
  const e = primitive.extensions?.[kExtension] ?? {};
  if (e.patch === undefined) throw new Problem(`a primitive has no "patch" in its ${kExtension}`);
  const what = `patch ${e.patch}`;
  if (!isIndex(e.material, materials)) {
    throw new Problem(`${what} is of material ${e.material}, expected below ${materials}`);
  }
  if (!isIndex(e.surface, surfaces)) {
    throw new Problem(`${what} is of surface ${e.surface}, expected below ${surfaces}`);
  }
  if (e.side !== 'front' && e.side !== 'back') {
    throw new Problem(`${what} is on side "${e.side}", expected "front" or "back"`);
  }
  const positions = await floats(parser, `${what}'s POSITION`, primitive.attributes.POSITION, 3);
  const nodes = positions.length / 3;
  // For others, and still a part of every patch.
  await floats(parser, `${what}'s COLOR_0`, primitive.attributes.COLOR_0, 3, nodes);
  const hidden =
    e.hidden === undefined ? null : Uint8Array.from(await numbers(parser, `${what}'s hidden`, e.hidden, 1, nodes));
  return {
    index: e.patch,
    material: e.material,
    surface: e.surface,
    side: e.side as Side,
    planar: e.planar === true,
    firstNode: 0,
    positions,
    normals: await floats(parser, `${what}'s NORMAL`, primitive.attributes.NORMAL, 3, nodes),
    indices: checkIndices(`${what}'s elements`, await numbers(parser, `${what}'s elements`, primitive.indices, 1), nodes),
    hidden,
    lobes: await readLobes(parser, what, e, nodes),
  };
}

async function readFaces(parser: Parser, e: DocumentExtension): Promise<Faces | null> {
  if (!e.faces) return null;
  const positions = await floats(parser, "the faces' positions", e.faces.positions, 3);
  const count = positions.length / 3;
  const indices = checkIndices('the faces', await numbers(parser, 'the faces', e.faces.indices, 1), count);
  const material = await numbers(parser, "the faces' materials", e.faces.material, 1, indices.length / 3);
  const materials = e.materials?.length ?? 0;
  if (material.some((m) => !isIndex(m, materials))) throw new Problem(`a face is of a material beyond ${materials}`);
  return {
    positions,
    normals: await floats(parser, "the faces' normals", e.faces.normals, 3, count),
    indices,
    material,
  };
}

function readCameras(json: Document): NamedCamera[] {
  return (json.nodes ?? []).flatMap((node) => {
    const camera = node.camera === undefined ? undefined : json.cameras?.[node.camera];
    if (!camera?.perspective || node.matrix?.length !== 16) return [];
    const name = node.name ?? camera.name ?? `camera ${node.camera}`;
    const { yfov, aspectRatio = 1 } = camera.perspective;
    if (!node.matrix.every(Number.isFinite) || !isFinitePositive(yfov) || yfov >= Math.PI || !isFinitePositive(aspectRatio)) {
      throw new Problem(`camera "${name}" is damaged: its matrix, field of view or aspect is no use`);
    }
    return [{
      name,
      matrix: new Matrix4().fromArray(node.matrix),
      fovY: yfov,
    }];
  });
}

/** Everything of a document that `checkDocument` passed. Throws Problem: what is wrong, without the file's name. */
export async function readSolution(parser: Parser, title: string): Promise<Solution> {
  const json = parser.json;
  const extension = checkDocument(json);
  const lobeMaterials = extension.materials ?? [];
  const materials = lobeMaterials.map((m, i) => readMaterial(i, json.materials?.[i] ?? {}, m ?? {}));
  const surfaceNames = extension.surfaceNames ?? [];
  const exposureScale = extension.exposureScale ?? 1;
  if (!isFinitePositive(exposureScale)) {
    throw new Problem(`has exposureScale ${exposureScale}, expected a positive number`);
  }

  const patches: Patch[] = [];
  for (const mesh of json.meshes ?? []) {
    for (const primitive of mesh.primitives) {
      patches.push(await readPatch(parser, primitive, surfaceNames.length, materials.length));
    }
  }
  patches.sort((a, b) => a.index - b.index);
  let nodeCount = 0, elementCount = 0;
  patches.forEach((patch, i) => {
    if (patch.index !== i) throw new Problem(`patch ${i} is missing or there twice`);
    patch.firstNode = nodeCount;
    nodeCount += patch.positions.length / 3;
    elementCount += patch.indices.length / 3;
  });
  return {
    title,
    materials,
    surfaceNames,
    patches,
    faces: await readFaces(parser, extension),
    cameras: readCameras(json),
    nodeCount,
    elementCount,
    exposureScale,
    trust: trustOf(extension),
  };
}
