import { Box3, Ray, Vector3 } from 'three';
import type { Patch, Solution } from '../solution/solution';
import type { Triangles } from '../solution/triangles';

/** A place on an element. */
export interface Pick {
  patch: Patch;
  /** Of the patch. */
  element: number;
  /** Nodes of the whole solution, their barycentric weights (hidden ones 0, the rest renormalised). */
  nodes: [number, number, number];
  weights: [number, number, number];
  /** The node that weighs most there; what `lobe inspect --pixel` names. */
  node: number;
  position: Vector3;
  distance: number;
}

/** Elements lie in faces; nearer by this share of the distance, a face is another one. */
const kApart = 1e-4;

/** The first element that a ray meets on its own side, unless a wall is before it: a face, which may show its black
 *  back, or, where the file holds no faces, the back of an element. */
export function pickAlong(solution: Solution, ray: Ray, seeThroughBacks = false): Pick | null {
  const { patches, faces, materials } = solution;
  let found: { patch: Patch; element: number } | null = null;
  let nearest = Infinity;
  for (const patch of patches) {
    meet(patch, ray, 'front', (element, distance) => {
      if (!(distance < nearest)) return;
      nearest = distance;
      found = { patch, element };
    });
  }
  if (!found) return null;
  let walled = false;
  const wall = (distance: number) => (walled ||= distance < (1 - kApart) * nearest);
  if (faces) {
    meet(faces, ray, seeThroughBacks ? 'front' : 'both', (face, distance) => {
      if (!materials[faces.material[face]].transmission) wall(distance);
    });
  } else if (!seeThroughBacks) {
    for (const patch of patches) {
      if (!materials[patch.material].transmission) meet(patch, ray, 'both', (_, distance) => wall(distance));
    }
  }
  const { patch, element } = found as { patch: Patch; element: number };
  return walled ? null : weigh(patch, element, ray.at(nearest, new Vector3()), nearest);
}

/** Triangles in a row lie together, so that few boxes of so many are met. */
const kRun = 64;
const runsOf = new WeakMap<object, Box3[]>();

function boxesOf(mesh: Triangles): Box3[] {
  let boxes = runsOf.get(mesh);
  if (boxes) return boxes;
  const { positions, indices } = mesh, point = new Vector3();
  boxes = Array.from({ length: Math.ceil(indices.length / (3 * kRun)) }, () => new Box3());
  indices.forEach((v, i) => boxes![Math.floor(i / (3 * kRun))].expandByPoint(point.fromArray(positions, 3 * v)));
  runsOf.set(mesh, boxes);
  return boxes;
}

/** Calls `hit` for all triangles on the way, in no order. The ray's direction has length 1. */
function meet(mesh: Triangles, ray: Ray, side: 'front' | 'both', hit: (triangle: number, distance: number) => void): void {
  const { positions, indices } = mesh;
  const a = new Vector3(), b = new Vector3(), c = new Vector3(), at = new Vector3();
  boxesOf(mesh).forEach((box, run) => {
    if (!ray.intersectsBox(box)) return;
    for (let i = 3 * kRun * run; i < Math.min(indices.length, 3 * kRun * (run + 1)); i += 3) {
      a.fromArray(positions, 3 * indices[i]);
      b.fromArray(positions, 3 * indices[i + 1]);
      c.fromArray(positions, 3 * indices[i + 2]);
      if (ray.intersectTriangle(a, b, c, side === 'front', at)) hit(i / 3, at.distanceTo(ray.origin));
    }
  });
}

function weigh(patch: Patch, element: number, position: Vector3, distance: number): Pick {
  const local = [0, 1, 2].map((k) => patch.indices[3 * element + k]);
  const corners = local.map((i) => new Vector3().fromArray(patch.positions, 3 * i));
  const normal = new Vector3().subVectors(corners[1], corners[0]).cross(
    new Vector3().subVectors(corners[2], corners[0]));
  const area = normal.lengthSq();
  const full = local.map((_, k) => {
    const p = corners[(k + 1) % 3], q = corners[(k + 2) % 3];
    return new Vector3().subVectors(p, position).cross(new Vector3().subVectors(q, position)).dot(normal) / area;
  });
  const seen = full.map((w, k) => (patch.hidden?.[local[k]] ? 0 : Math.max(0, w)));
  const sum = seen[0] + seen[1] + seen[2];
  // Where all are hidden there is no light, and still a node to look at.
  const weights = sum > 0 ? seen.map((w) => w / sum) : full;
  const loudest = weights.indexOf(Math.max(...weights));
  const nodes = local.map((i) => patch.firstNode + i);
  return {
    patch, element, position, distance,
    nodes: nodes as Pick['nodes'],
    weights: weights as Pick['weights'],
    node: nodes[loudest],
  };
}
