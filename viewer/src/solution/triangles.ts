/** Elements of a patch, or the scene's faces. */
export interface Triangles {
  positions: Float32Array;
  /** Three a triangle. */
  indices: Uint32Array;
}

/** Square metres. */
export function areaOf({ positions: p, indices }: Triangles, triangle: number): number {
  const [a, b, c] = [0, 1, 2].map((k) => 3 * indices[3 * triangle + k]);
  const u = [p[b] - p[a], p[b + 1] - p[a + 1], p[b + 2] - p[a + 2]];
  const v = [p[c] - p[a], p[c + 1] - p[a + 1], p[c + 2] - p[a + 2]];
  return 0.5 * Math.hypot(u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]);
}
