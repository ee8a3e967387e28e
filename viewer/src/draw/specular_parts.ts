/** What of a solution reflects as a mirror or lets see through, cut into parts that are drawn as one. */
import { Box3, Plane, Vector3 } from 'three';
import type { Faces, Solution } from '../solution/solution';
import { areaOf } from '../solution/triangles';
import { isFlat, type Layout, type PlacedPatch } from './layout';

export interface SpecularPart {
  material: number;
  /** All of it lies in this plane; null: it is curved. A mirror is on the positive side; a pane is on both. */
  plane: Plane | null;
  box: Box3;
  /** Square metres. */
  area: number;
  /** Cubic metres inside: 0 but of closed bodies of glass. */
  volume: number;
  /** Of a mirror. */
  patches: PlacedPatch[];
  /** Of glass: three corners a triangle, three floats each. */
  glass: { positions: Float32Array; normals: Float32Array } | null;
}

const kFlat = 1e-4;  // of unit normals; of offsets, in scene diagonals
const kNothing = 1e-12;  // of areas, in squares of the scene's diagonal

/** A planar mirror is what coplanar patches of one material make; every curved patch is one by itself. */
export function mirrorsOf(solution: Solution, layout: Layout, diagonal: number): SpecularPart[] {
  const parts: SpecularPart[] = [];
  for (const placed of layout.patches) {
    const { patch } = placed;
    const material = solution.materials[patch.material];
    if (material.kind !== 'mirror' || material.transmission || patch.indices.length === 0) continue;
    const plane = patch.planar
      ? new Plane().setFromNormalAndCoplanarPoint(
        new Vector3().fromArray(patch.normals), new Vector3().fromArray(patch.positions, 3 * patch.indices[0]))
      : null;
    let part = parts.find(
      (p) => p.material === patch.material && p.plane && plane && isSame(p.plane, plane, diagonal) &&
        isFlat(p.patches[0].patch) === isFlat(patch));
    if (!part) parts.push((part = { material: patch.material, plane, box: new Box3(), area: 0, volume: 0, patches: [], glass: null }));
    part.patches.push(placed);
    part.box.union(new Box3().setFromArray(patch.positions as never));
    for (let e = 0; e < patch.indices.length / 3; ++e) part.area += areaOf(patch, e);
  }
  return parts;
}

export function isSame(a: Plane, b: Plane, diagonal: number): boolean {
  return a.normal.distanceTo(b.normal) < kFlat && Math.abs(a.constant - b.constant) < kFlat * diagonal;
}

/** Glass in pieces that hang together. */
export function glassOf(solution: Solution, diagonal: number): SpecularPart[] {
  const { faces, materials } = solution;
  if (!faces || !materials.some((m) => m.transmission)) return [];
  const glass: number[] = [];
  for (let f = 0; f < faces.indices.length / 3; ++f) if (materials[faces.material[f]].transmission) glass.push(f);
  return pieces(faces, glass).map((piece) => glassPart(faces, piece, diagonal));
}

/** Faces that share a place and a material. */
function pieces(faces: Faces, glass: readonly number[]): number[][] {
  const parent = new Map<string, string>();
  const root = (key: string): string => {
    let at = key;
    for (let up = parent.get(at); up !== undefined && up !== at; up = parent.get(at)) at = up;
    return at;
  };
  const keyOf = (f: number, k: number) => {
    const v = 3 * faces.indices[3 * f + k];
    return `${faces.material[f]} ${faces.positions.slice(v, v + 3).join(' ')}`;
  };
  for (const f of glass) {
    for (let k = 0; k < 3; ++k) {
      const key = keyOf(f, k);
      if (!parent.has(key)) parent.set(key, key);
      parent.set(root(key), root(keyOf(f, 0)));
    }
  }
  const found = new Map<string, number[]>();
  for (const f of glass) {
    const key = root(keyOf(f, 0)), piece = found.get(key);
    if (piece) piece.push(f);
    else found.set(key, [f]);
  }
  return [...found.values()];
}

function glassPart(faces: Faces, piece: readonly number[], diagonal: number): SpecularPart {
  const positions = new Float32Array(9 * piece.length), normals = new Float32Array(9 * piece.length);
  const part: SpecularPart = {
    material: faces.material[piece[0]], plane: null, box: new Box3(), area: 0, volume: 0, patches: [],
    glass: { positions, normals },
  };
  let flat = true;
  piece.forEach((f, at) => {
    const corners = [0, 1, 2].map((k) => {
      const v = 3 * faces.indices[3 * f + k];
      positions.set(faces.positions.subarray(v, v + 3), 9 * at + 3 * k);
      normals.set(faces.normals.subarray(v, v + 3), 9 * at + 3 * k);
      return new Vector3().fromArray(faces.positions, v);
    }) as [Vector3, Vector3, Vector3];
    corners.forEach((c) => part.box.expandByPoint(c));
    const area = areaOf(faces, f);
    part.area += area;
    part.volume += corners[0].dot(corners[1].clone().cross(corners[2])) / 6;
    // A triangle without area has no plane.
    if (area < kNothing * diagonal ** 2) return;
    const plane = new Plane().setFromCoplanarPoints(...corners);
    part.plane ??= plane;
    flat &&= isSame(part.plane, plane, diagonal) || isSame(part.plane, plane.negate(), diagonal);
  });
  if (!flat) part.plane = null;
  part.volume = flat ? 0 : Math.abs(part.volume);
  return part;
}
