import { Matrix4, PerspectiveCamera, Plane, Vector3, Vector4 } from 'three';

/** x -> what a mirror shows at x. */
export function reflectionIn({ normal: n, constant }: Plane): Matrix4 {
  const row = (a: number, i: number) => [0, 1, 2].map((j) => (i === j ? 1 : 0) - 2 * a * n.getComponent(j));
  const [x, y, z] = [row(n.x, 0), row(n.y, 1), row(n.z, 2)], t = -2 * constant;
  return new Matrix4().set(
    x[0], x[1], x[2], t * n.x, y[0], y[1], y[2], t * n.y, z[0], z[1], z[2], t * n.z, 0, 0, 0, 1);
}

const flip = new Matrix4().makeScale(-1, 1, 1);

/**
 * The eye behind a mirror. Its picture is flipped, left to right, so that it is no mirrored camera but one that turns
 * triangles as others do; what pixel x of the mirror shows is then exactly its pixel width - x.
 */
export class MirroredCamera extends PerspectiveCamera {
  constructor() {
    super();
    this.matrixAutoUpdate = this.matrixWorldAutoUpdate = false;
  }

  /** `plane` has the eye on its positive side. What is behind it is left out, but for `slack` metres: else the sill
   *  of a mirror would be a black line. `reach`: metres from the mirrored eye to the end of the scene. */
  reflect(camera: PerspectiveCamera, plane: Plane, slack: number, reach: (eye: Vector3) => number): void {
    this.matrixWorld.copy(reflectionIn(plane)).multiply(camera.matrixWorld).multiply(flip);
    this.matrixWorldInverse.copy(this.matrixWorld).invert();
    this.fov = camera.fov;
    this.aspect = camera.aspect;
    this.near = camera.near;
    this.far = reach(new Vector3().setFromMatrixPosition(this.matrixWorld));
    this.updateProjectionMatrix();

    // The near plane is put into the mirror (E. Lengyel, "Oblique View Frustum Depth Projection and Clipping",
    // J. Game Development 1(2), 2005, eq. 7): nothing between eye and mirror is seen, at no cost.
    const here = plane.clone();
    here.constant += slack;
    here.applyMatrix4(this.matrixWorldInverse);
    const p = this.projectionMatrix.elements;
    const clip = new Vector4(here.normal.x, here.normal.y, here.normal.z, here.constant);
    const corner = new Vector4(
      (Math.sign(clip.x) + p[8]) / p[0], (Math.sign(clip.y) + p[9]) / p[5], -1, (1 + p[10]) / p[14]);
    clip.multiplyScalar(2 / clip.dot(corner));
    p[2] = clip.x;
    p[6] = clip.y;
    p[10] = clip.z + 1;
    p[14] = clip.w;
    this.projectionMatrixInverse.copy(this.projectionMatrix).invert();
  }
}
