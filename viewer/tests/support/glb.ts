export type Values = Float32Array | Uint32Array | Uint16Array | Uint8Array;

const kComponentType = (values: Values): number =>
  values instanceof Float32Array ? 5126 : values instanceof Uint32Array ? 5125 : values instanceof Uint16Array ? 5123 : 5121;

const align = (n: number): number => (n + 3) & ~3;

/** What glTF demands of positions. */
function limits(values: Values): { min: number[]; max: number[] } {
  const component = (k: number) => Array.from(values).filter((_, i) => i % 3 === k);
  const each = (f: (...v: number[]) => number) => [0, 1, 2].map((k) => f(...component(k)));
  return { min: each(Math.min), max: each(Math.max) };
}

/** A .glb file in the making: accessors first, whose indices go into the JSON. */
export class Glb {
  /** Tests write what they like into it. */
  readonly json: any = { asset: { version: '2.0' }, buffers: [], bufferViews: [], accessors: [] };
  /** What accessors hold, by index; may be changed until `bytes`. */
  readonly values: Values[] = [];
  private binaryBytes = 0;

  accessor(values: Values, type: 'SCALAR' | 'VEC3' = 'SCALAR'): number {
    const { bufferViews, accessors } = this.json;
    bufferViews.push({ buffer: 0, byteOffset: this.binaryBytes, byteLength: values.byteLength });
    accessors.push({
      bufferView: bufferViews.length - 1,
      componentType: kComponentType(values),
      count: values.length / (type === 'VEC3' ? 3 : 1),
      type,
      ...(type === 'VEC3' ? limits(values) : {}),
    });
    this.binaryBytes += align(values.byteLength);
    this.json.buffers = [{ byteLength: this.binaryBytes }];
    return this.values.push(values) - 1;
  }

  bytes(): ArrayBuffer {
    const text = new TextEncoder().encode(JSON.stringify(this.json));
    const json = align(text.length), binary = this.binaryBytes;
    const out = new ArrayBuffer(12 + 8 + json + 8 + binary);
    const view = new DataView(out), all = new Uint8Array(out);
    [0x46546c67, 2, out.byteLength, json, 0x4e4f534a].forEach((word, i) => view.setUint32(4 * i, word, true));
    all.fill(0x20, 20, 20 + json);
    all.set(text, 20);
    [binary, 0x004e4942].forEach((word, i) => view.setUint32(20 + json + 4 * i, word, true));
    let at = 28 + json;
    for (const values of this.values) {
      all.set(new Uint8Array(values.buffer, values.byteOffset, values.byteLength), at);
      at += align(values.byteLength);
    }
    return out;
  }
}
