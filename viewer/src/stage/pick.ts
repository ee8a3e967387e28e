import { Ray, Vector3 } from 'three';
import type { Patch, Solution } from '../solution/solution';

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

/** The first element that a ray meets on its own side. Linear in the elements: for clicks, not for frames. */
export function pickAlong(solution: Solution, ray: Ray): Pick | null {
  const a = new Vector3(), b = new Vector3(), c = new Vector3(), at = new Vector3(), hit = new Vector3();
  let found: { patch: Patch; element: number } | null = null;
  let nearest = Infinity;
  for (const patch of solution.patches) {
    const { positions, indices } = patch;
    for (let i = 0; i < indices.length; i += 3) {
      a.fromArray(positions, 3 * indices[i]);
      b.fromArray(positions, 3 * indices[i + 1]);
      c.fromArray(positions, 3 * indices[i + 2]);
      if (!ray.intersectTriangle(a, b, c, true, at)) continue;
      const distance = at.distanceTo(ray.origin);
      if (!(distance < nearest)) continue;
      nearest = distance;
      found = { patch, element: i / 3 };
      hit.copy(at);
    }
  }
  return found && weigh(found.patch, found.element, hit, nearest);
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
