import { Vector3 } from 'three';
import { findView, loadSolution } from './solution/load';
import { Problem } from './solution/problem';
import { Stage } from './stage/stage';

async function start(): Promise<void> {
  const view = await findView(location.search);
  const solution = await loadSolution(view, () => {});
  const stage = new Stage(document.querySelector('canvas')!, solution);
  const camera = solution.cameras[0];
  if (camera) {
    const eye = new Vector3().setFromMatrixColumn(camera.matrix, 3);
    const back = new Vector3().setFromMatrixColumn(camera.matrix, 2);
    stage.setPose({
      eye, target: eye.clone().sub(back), up: new Vector3().setFromMatrixColumn(camera.matrix, 1),
      fov: (camera.fovY * 180) / Math.PI,
    });
  }
}

start().catch((error: unknown) => {
  document.body.textContent = error instanceof Problem ? error.message : String(error);
});
