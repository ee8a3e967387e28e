/** A .glb whose JSON `change` has had in its hands. */
export function changeGlb(bytes, change) {
  const length = bytes.readUInt32LE(12), json = JSON.parse(bytes.subarray(20, 20 + length).toString());
  change(json);
  const text = JSON.stringify(json), padded = Buffer.from(text.padEnd(text.length + (-Buffer.byteLength(text) & 3)));
  const out = Buffer.concat([bytes.subarray(0, 20), padded, bytes.subarray(20 + length)]);
  out.writeUInt32LE(out.length, 8);
  out.writeUInt32LE(padded.length, 12);
  return out;
}

/** The JSON of a .glb, and the floats of an accessor of it: just enough to check what others made of them. */
export function openGlb(bytes) {
  const length = bytes.readUInt32LE(12);
  const json = JSON.parse(bytes.subarray(20, 20 + length).toString());
  const binary = bytes.subarray(28 + length);
  const floats = (accessor) => {
    const { bufferView, byteOffset = 0, count, type, componentType } = json.accessors[accessor];
    if (componentType !== 5126) throw new Error(`accessor ${accessor} does not hold floats`);
    const at = (json.bufferViews[bufferView].byteOffset ?? 0) + byteOffset;
    return Float32Array.from({ length: count * { SCALAR: 1, VEC3: 3, VEC4: 4 }[type] }, (_, i) => binary.readFloatLE(at + 4 * i));
  };
  return { json, floats };
}
