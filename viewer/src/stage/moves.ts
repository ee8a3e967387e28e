/** Ways to move a pose; mathematics alone. All take a pose and give a new one. */
import { Quaternion, Vector3 } from 'three';
import type { Pose } from './stage';

/** How near to the pole an eye may go, radians: beyond it up would be down. */
const kPole = 0.01;

export function forwardOf(pose: Pose): Vector3 {
  return pose.target.clone().sub(pose.eye).normalize();
}

export function rightOf(pose: Pose): Vector3 {
  return forwardOf(pose).cross(pose.up).normalize();
}

/** `arm` turned about up by `yaw`, and towards up by `pitch` as far as the pole allows; radians. */
function turned(arm: Vector3, up: Vector3, yaw: number, pitch: number): Vector3 {
  const axis = up.clone().normalize();
  const out = arm.clone().applyAxisAngle(axis, yaw);
  const angle = out.angleTo(axis);
  const next = Math.min(Math.PI - kPole, Math.max(kPole, angle - pitch));
  const right = out.clone().cross(axis);
  if (right.lengthSq() < 1e-12 * out.lengthSq()) return out;
  return out.applyAxisAngle(right.normalize(), angle - next);
}

/** The eye about its target. */
export function orbit(pose: Pose, yaw: number, pitch: number): Pose {
  const arm = turned(pose.eye.clone().sub(pose.target), pose.up, yaw, pitch);
  return { ...pose, eye: pose.target.clone().add(arm) };
}

/** The head about itself: the target about the eye. */
export function look(pose: Pose, yaw: number, pitch: number): Pose {
  const arm = turned(pose.target.clone().sub(pose.eye), pose.up, yaw, pitch);
  return { ...pose, target: pose.eye.clone().add(arm) };
}

export function shift(pose: Pose, by: Vector3): Pose {
  return { ...pose, eye: pose.eye.clone().add(by), target: pose.target.clone().add(by) };
}

/** What is at the target's distance follows a pointer that moves by (dx, dy) CSS pixels on a canvas `height` high. */
export function pan(pose: Pose, dx: number, dy: number, height: number): Pose {
  const distance = pose.eye.distanceTo(pose.target);
  const metres = (2 * distance * Math.tan((pose.fov * Math.PI) / 360)) / height;
  const right = rightOf(pose), up = right.clone().cross(forwardOf(pose));
  return shift(pose, right.multiplyScalar(-dx * metres).addScaledVector(up, dy * metres));
}

/** Everything `factor` as far from `towards`, which stays where it is on the canvas. The eye comes no nearer than
 *  `nearest` metres to that, nor to its target. */
export function zoom(pose: Pose, towards: Vector3, factor: number, nearest: number): Pose {
  const apart = pose.eye.distanceTo(towards);
  const by = factor < 1 ? Math.max(factor, Math.min(1, nearest / apart)) : factor;
  const eye = pose.eye.clone().sub(towards).multiplyScalar(by).add(towards);
  const distance = Math.max(nearest, by * pose.eye.distanceTo(pose.target));
  return { ...pose, eye, target: eye.clone().addScaledVector(forwardOf(pose), distance) };
}

/** A step of (right, up, ahead) metres; ahead and right are level, as one walks. */
export function walk(pose: Pose, right: number, up: number, ahead: number): Pose {
  const axis = pose.up.clone().normalize();
  const side = rightOf(pose);
  const level = axis.clone().cross(side);
  return shift(pose, side.multiplyScalar(right).addScaledVector(axis, up).addScaledVector(level, ahead));
}

/** Between two poses: eyes on a line, directions on an arc, by an eased `t` 0..1. */
export function between(a: Pose, b: Pose, t: number): Pose {
  if (t >= 1) return b;
  const s = t * t * (3 - 2 * t);
  const mix = (p: number, q: number) => p + s * (q - p);
  const eye = a.eye.clone().lerp(b.eye, s);
  const from = forwardOf(a), turn = new Quaternion().setFromUnitVectors(from, forwardOf(b));
  const direction = from.applyQuaternion(new Quaternion().slerp(turn, s));
  const distance = mix(a.eye.distanceTo(a.target), b.eye.distanceTo(b.target));
  return {
    eye,
    target: eye.clone().addScaledVector(direction, distance),
    up: a.up.clone().lerp(b.up, s).normalize(),
    fov: mix(a.fov, b.fov),
  };
}
