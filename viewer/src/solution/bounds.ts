import { Box3, Vector3 } from 'three';
import type { Solution } from './solution';

const known = new WeakMap<Solution, Box3>();

/** Of all there is; where there is nothing, a box of two metres. Looked for once: not to be changed. */
export function boundsOf(solution: Solution): Box3 {
  let box = known.get(solution);
  if (!box) known.set(solution, (box = findBounds(solution)));
  return box;
}

function findBounds({ patches, faces }: Solution): Box3 {
  const box = new Box3(), part = new Box3();
  for (const { positions } of [...patches, ...(faces ? [faces] : [])]) box.union(part.setFromArray(positions));
  return box.isEmpty() ? new Box3(new Vector3(-1, -1, -1), new Vector3(1, 1, 1)) : box;
}
