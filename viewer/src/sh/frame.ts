/** A direction or point: x, y, z. */
export type Vec3 = readonly [number, number, number];

/** A node's axes in world space; z is its shading normal. */
export interface Frame {
  x: Vec3;
  y: Vec3;
  z: Vec3;
}

/** The frame that docs/conventions.md#frame fixes for a unit normal (Duff et al., JCGT 6(1), 2017). */
export function frameOf(n: Vec3): Frame {
  const s = n[2] < 0 || Object.is(n[2], -0) ? -1 : 1;
  const a = -1 / (s + n[2]);
  const b = n[0] * n[1] * a;
  return { x: [1 + s * n[0] * n[0] * a, s * b, -s * n[0]], y: [b, s + n[1] * n[1] * a, -n[1]], z: n };
}

export function dot(a: Vec3, b: Vec3): number {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/** World to frame. What lies below the horizon is bent to it (docs/conventions.md#horizon). */
export function toLocal(f: Frame, w: Vec3): Vec3 {
  const x = dot(f.x, w), y = dot(f.y, w), z = dot(f.z, w);
  if (z >= 0) return [x, y, z];
  const length = Math.hypot(x, y);
  return length > 0 ? [x / length, y / length, 0] : [1, 0, 0];
}

/** Frame to world. */
export function toWorld(f: Frame, v: Vec3): Vec3 {
  const at = (i: 0 | 1 | 2) => f.x[i] * v[0] + f.y[i] * v[1] + f.z[i] * v[2];
  return [at(0), at(1), at(2)];
}
