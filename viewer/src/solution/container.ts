/**
 * The outer shape of a glTF file, checked before three's loader reads it: the loader trusts what a file says of its own
 * sizes, and its messages speak of typed arrays, not of the file.
 */
import { Problem } from './problem';
import type { Document } from './read';

interface BufferView {
  buffer?: number;
  byteOffset?: number;
  byteLength?: number;
  byteStride?: number;
}

interface Accessor {
  bufferView?: number;
  byteOffset?: number;
  componentType?: number;
  count?: number;
  type?: string;
  sparse?: unknown;
}

/** What only this file looks at. */
interface Shape extends Document {
  buffers?: { uri?: string; byteLength?: number }[];
  bufferViews?: BufferView[];
  accessors?: Accessor[];
}

const kGlbMagic = 0x46546c67, kJsonChunk = 0x4e4f534a, kBinaryChunk = 0x004e4942;

const kComponents: Record<string, number> = { SCALAR: 1, VEC2: 2, VEC3: 3, VEC4: 4, MAT2: 4, MAT3: 9, MAT4: 16 };
const kComponentBytes: Record<number, number> = { 5120: 1, 5121: 1, 5122: 2, 5123: 2, 5125: 4, 5126: 4 };

const isCount = (value: unknown): value is number => Number.isSafeInteger(value) && (value as number) >= 0;

function parseJson(bytes: Uint8Array): Shape {
  let json: unknown;
  try {
    json = JSON.parse(new TextDecoder().decode(bytes));
  } catch (error) {
    throw new Problem(`holds JSON that is damaged: ${(error as Error).message}`);
  }
  if (typeof json !== 'object' || json === null) throw new Problem('is neither a .glb nor a .gltf file');
  return json as Shape;
}

/** The JSON of a .glb and how long its binary chunk is. */
function openGlb(bytes: ArrayBuffer): { json: Shape; binary: number } {
  const view = new DataView(bytes);
  const version = view.getUint32(4, true), length = view.getUint32(8, true);
  if (version !== 2) throw new Problem(`is a .glb file of version ${version}, expected 2`);
  if (length !== bytes.byteLength) {
    throw new Problem(`has ${bytes.byteLength} bytes, and its header says ${length}: it is damaged or not whole`);
  }
  let json: Shape | null = null, binary = 0;
  for (let at = 12; at < length; ) {
    const size = at + 8 <= length ? view.getUint32(at, true) : Infinity;
    if (at + 8 + size > length) throw new Problem('is damaged: one of its chunks ends beyond the file');
    const kind = view.getUint32(at + 4, true);
    if (kind === kJsonChunk && !json) json = parseJson(new Uint8Array(bytes, at + 8, size));
    if (kind === kBinaryChunk) binary = size;
    at += 8 + size;
  }
  if (!json) throw new Problem('is damaged: it has no JSON chunk');
  return { json, binary };
}

function checkBufferView(json: Shape, i: number, view: BufferView): void {
  const buffer = json.buffers?.[view.buffer ?? -1];
  const { byteOffset = 0, byteLength, byteStride = 0 } = view;
  if (!buffer || !isCount(byteOffset) || !isCount(byteLength) || !isCount(byteStride) ||
      byteOffset + byteLength > (buffer.byteLength ?? 0)) {
    throw new Problem(`is damaged: its bufferView ${i} is not inside a buffer`);
  }
}

function checkAccessor(json: Shape, i: number, accessor: Accessor): void {
  const what = `its accessor ${i}`;
  if (accessor.sparse !== undefined) throw new Problem(`cannot be read: ${what} is sparse`);
  const bytes = kComponentBytes[accessor.componentType ?? 0], components = kComponents[accessor.type ?? ''];
  const { count, byteOffset = 0 } = accessor;
  if (!bytes || !components || !isCount(count)) {
    throw new Problem(
      `is damaged: ${what} has ${accessor.count} entries of type ${accessor.type}, component ${accessor.componentType}`);
  }
  const view = json.bufferViews?.[accessor.bufferView ?? -1];
  const stride = view?.byteStride || bytes * components;
  if (!view || !isCount(byteOffset) || byteOffset % bytes !== 0 || stride % bytes !== 0 ||
      stride < bytes * components ||
      (count > 0 && byteOffset + stride * (count - 1) + bytes * components > view.byteLength!)) {
    throw new Problem(`is damaged: ${what} of ${count} entries is not inside its bufferView`);
  }
}

function checkShape(json: Shape, binary: number): void {
  for (const member of ['buffers', 'bufferViews', 'accessors', 'meshes', 'nodes', 'cameras', 'materials'] as const) {
    const list: unknown = json[member] ?? [];
    if (!Array.isArray(list) || list.some((entry) => typeof entry !== 'object' || entry === null)) {
      throw new Problem(`is damaged: its "${member}" is no list of objects`);
    }
  }
  json.buffers?.forEach((buffer, i) => {
    if (!isCount(buffer.byteLength) || (buffer.uri === undefined && buffer.byteLength > binary)) {
      throw new Problem(`is damaged: its buffer ${i} should have ${buffer.byteLength} bytes, and ${binary} are there`);
    }
  });
  json.bufferViews?.forEach((view, i) => checkBufferView(json, i, view));
  json.accessors?.forEach((accessor, i) => checkAccessor(json, i, accessor));
  // Solutions are flat; the loader would wait forever for a node that is its own descendant.
  if (json.nodes?.some((node) => 'children' in node)) throw new Problem('is damaged: a node of it has children');
}

/** The JSON of a .glb or .gltf file; `look` is called with it before the sizes in it are checked. Throws Problem. */
export function checkContainer(bytes: ArrayBuffer, look: (json: Document) => void = () => {}): void {
  if (bytes.byteLength === 0) throw new Problem('is empty');
  const head = new DataView(bytes);
  if (bytes.byteLength >= 20 && head.getUint32(0, true) === kGlbMagic) {
    const { json, binary } = openGlb(bytes);
    look(json);
    checkShape(json, binary);
  } else if (head.getUint8(0) === '{'.charCodeAt(0)) {
    const json = parseJson(new Uint8Array(bytes));
    look(json);
    checkShape(json, 0);
  } else {
    throw new Problem('is neither a .glb nor a .gltf file');
  }
}
