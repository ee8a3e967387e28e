/** Poses that a solution suggests: its named cameras, all of it, a place in it. */
import { Ray, Vector3 } from 'three';
import { boundsOf } from '../solution/bounds';
import type { NamedCamera, Solution } from '../solution/solution';
import { pickAlong } from './pick';
import type { Pose } from './stage';

const kUp = new Vector3(0, 1, 0);
/** What a camera turns about is at least so far away, in scene diagonals. */
const kNearest = 1e-4;

/** What the camera sees, turning about what is in its middle. */
export function poseOfCamera(solution: Solution, camera: NamedCamera): Pose {
  const column = (i: number) => new Vector3().setFromMatrixColumn(camera.matrix, i);
  const eye = column(3), ahead = column(2).normalize().negate();
  const met = pickAlong(solution, new Ray(eye, ahead), true);
  const box = boundsOf(solution);
  const distance = met?.distance ?? box.getCenter(new Vector3()).distanceTo(eye);
  // A camera without roll may as well have the world's up, so that orbits stay level.
  const level = Math.abs(column(0).normalize().y) < 1e-4 && column(1).y > 0 && Math.abs(ahead.y) < 0.999;
  return {
    eye,
    target: eye.clone().addScaledVector(ahead, Math.max(distance, kNearest * box.min.distanceTo(box.max))),
    up: level ? kUp.clone() : column(1).normalize(),
    fov: (camera.fovY * 180) / Math.PI,
  };
}

/** All of it from where the eye looks now, or from a corner above. */
export function poseOfAll(solution: Solution, now?: Pose): Pose {
  const box = boundsOf(solution), centre = box.getCenter(new Vector3());
  const radius = 0.5 * box.getSize(new Vector3()).length();
  const fov = now?.fov ?? 45;
  const away = now ? now.eye.clone().sub(now.target).normalize() : new Vector3(0.6, 0.45, 0.66).normalize();
  const distance = radius / Math.sin((fov * Math.PI) / 360);
  return { eye: centre.clone().addScaledVector(away, distance), target: centre, up: now?.up.clone() ?? kUp.clone(), fov };
}

/** A place in the middle, from the side the eye is on, near enough to see it. */
export function poseOfPlace(now: Pose, place: Vector3, metresWide: number): Pose {
  const distance = metresWide / (2 * Math.tan((now.fov * Math.PI) / 360));
  const away = now.eye.clone().sub(place).normalize();
  if (away.lengthSq() === 0) away.set(0, 0, 1);
  return { ...now, eye: place.clone().addScaledVector(away, Math.min(distance, now.eye.distanceTo(place) || distance)), target: place.clone() };
}
