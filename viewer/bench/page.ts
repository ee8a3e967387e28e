/** What frames.mjs and compare.mjs drive (stage.mjs): a stage without panels. */
import { Vector3 } from 'three';
import { Picture } from '../src/draw/picture';
import { loadSolution } from '../src/solution/load';
import type { NamedCamera } from '../src/solution/solution';
import { Stage, type Pose } from '../src/stage/stage';

function poseOf({ matrix, fovY }: NamedCamera): Pose {
  const eye = new Vector3().setFromMatrixColumn(matrix, 3), back = new Vector3().setFromMatrixColumn(matrix, 2);
  return { eye, target: eye.clone().sub(back), up: new Vector3().setFromMatrixColumn(matrix, 1), fov: (fovY * 180) / Math.PI };
}

async function open() {
  const solution = await loadSolution({ solution: 'solution.glb', title: 'solution.glb' }, () => {});
  const stage = new Stage(document.querySelector('canvas')!, solution);
  const look = (i: number) => stage.setPose(poseOf(solution.cameras[i]));
  look(0);
  Object.assign(bench, { solution, stage, look });
}

const bench = { Picture, ready: Promise.resolve() };
bench.ready = open();
Object.assign(window, { lobe: bench });
