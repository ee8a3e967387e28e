/**
 * Pointer, wheel and keys that move the eye. Orbit: drag to turn about the target, right or shift drag to shift, wheel
 * towards what is under the cursor; fingers: one turns, two shift and pinch. Walk: drag and arrows look, W A S D and
 * Q E step.
 */
import { Vector3 } from 'three';
import type { Flight } from './flight';
import { forwardOf, look, orbit, pan, walk, zoom } from './moves';
import type { Stage } from './stage';

export type Mode = 'orbit' | 'walk';

/** A pointer that moved less than this many CSS pixels has clicked. */
const kSlop = 5;
/** A drag across the canvas' height turns half a circle, of the head a quarter. */
const kOrbitPerHeight = Math.PI;
const kLookPerHeight = Math.PI / 2;
/** Radians a second by arrow keys. */
const kTurnRate = 1.2;
/** The least that a key does, however short it is pressed; seconds. */
const kTap = 0.05;
/** How near the wheel and keys bring the eye to a place, over the scene's diagonal: nearer, single precision shows. */
const kNearest = 1e-4;
/** Ways that a picked place serves for the wheel; milliseconds. Picking is linear in the elements. */
const kWheelPause = 500;

const steps: Readonly<Record<string, readonly [right: number, up: number, ahead: number]>> = {
  KeyW: [0, 0, 1], KeyS: [0, 0, -1], KeyA: [-1, 0, 0], KeyD: [1, 0, 0], KeyQ: [0, -1, 0], KeyE: [0, 1, 0],
};
const arrows: Readonly<Record<string, readonly [right: number, up: number]>> = {
  ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1],
};

interface Finger {
  x: number;
  y: number;
}

export interface ControlsOptions {
  /** The scene's diagonal, metres. */
  size: number;
  signal: AbortSignal;
  onClick(x: number, y: number, shift: boolean): void;
  onMode(mode: Mode, speed: number): void;
}

export class Controls {
  private current: Mode = 'orbit';
  /** m/s: a room is crossed in a few seconds, a hall too. */
  private metresASecond: number;
  private readonly fingers = new Map<number, Finger>();
  private readonly held = new Set<string>();
  private shifted = false;
  private lastStep = 0;
  private frame = 0;
  /** `moved`: how far from where it was pressed, at most; CSS pixels. */
  private drag: { from: Finger; shift: boolean; button: number; moved: number; fingers: number } | null = null;
  private wheelPlace: { x: number; y: number; time: number; place: Vector3 } | null = null;

  constructor(private readonly stage: Stage, private readonly flight: Flight, private readonly options: ControlsOptions) {
    this.metresASecond = Number((options.size / 8).toPrecision(2));
    const { canvas } = stage, { signal } = options;
    canvas.style.touchAction = 'none';
    canvas.addEventListener('pointerdown', (e) => this.down(e), { signal });
    canvas.addEventListener('pointermove', (e) => this.move(e), { signal });
    canvas.addEventListener('pointerup', (e) => this.up(e, true), { signal });
    canvas.addEventListener('pointercancel', (e) => this.up(e, false), { signal });
    canvas.addEventListener('contextmenu', (e) => e.preventDefault(), { signal });
    canvas.addEventListener('wheel', (e) => this.wheel(e), { signal, passive: false });
    window.addEventListener('keyup', (e) => this.keyUp(e), { signal });
    window.addEventListener('blur', () => this.release(), { signal });
    signal.addEventListener('abort', () => this.release());
  }

  get mode(): Mode {
    return this.current;
  }

  get speed(): number {
    return this.metresASecond;
  }

  private get nearest(): number {
    return kNearest * this.options.size;
  }

  setMode(mode: Mode): void {
    if (mode === this.current) return;
    this.current = mode;
    this.release();
    this.options.onMode(mode, this.speed);
  }

  setSpeed(metresASecond: number): void {
    const { size } = this.options;
    this.metresASecond = Math.min(size, Math.max(size / 400, metresASecond));
    this.options.onMode(this.mode, this.speed);
  }

  /** A key went down that nobody else wants. Says whether it moves the eye. */
  keyDown(event: KeyboardEvent): boolean {
    const moves = event.code in arrows || (this.mode === 'walk' && event.code in steps) || isZoom(event.key);
    if (!moves || event.ctrlKey || event.metaKey || event.altKey) return false;
    this.shifted = event.shiftKey;
    if (isZoom(event.key)) {
      this.flight.stop();
      const factor = event.key === '-' || event.key === '_' ? 1.15 : 1 / 1.15;
      this.stage.setPose(zoom(this.stage.pose, this.stage.target, factor, this.nearest));
      return true;
    }
    if (!this.held.has(event.code)) {
      this.held.add(event.code);
      this.flight.stop();
      this.go(kTap);
      if (!this.frame) {
        this.lastStep = performance.now();
        this.frame = requestAnimationFrame((now) => this.tick(now));
      }
    }
    return true;
  }

  private keyUp(event: KeyboardEvent): void {
    this.held.delete(event.code);
    this.shifted = event.shiftKey;
    // macOS tells of no key that is let go while Command is down.
    if (event.key === 'Meta') this.held.clear();
  }

  private release(): void {
    this.held.clear();
    this.fingers.clear();
    this.drag = null;
    cancelAnimationFrame(this.frame);
    this.frame = 0;
  }

  private tick(now: number): void {
    this.frame = 0;
    if (this.held.size === 0) return;
    // A page that stood still does not jump.
    this.go(Math.min(0.1, Math.max(0, (now - this.lastStep) / 1000)));
    this.lastStep = now;
    this.frame = requestAnimationFrame((next) => this.tick(next));
  }

  /** What the keys that are held do in `seconds`. */
  private go(seconds: number): void {
    let pose = this.stage.pose;
    const turn: [number, number] = [0, 0], step: [number, number, number] = [0, 0, 0];
    for (const code of this.held) {
      arrows[code]?.forEach((v, i) => (turn[i] += v));
      if (this.mode === 'walk') steps[code]?.forEach((v, i) => (step[i] += v));
    }
    const angle = kTurnRate * seconds;
    if (turn[0] !== 0 || turn[1] !== 0) {
      if (this.mode === 'walk') pose = look(pose, -turn[0] * angle, turn[1] * angle);
      else if (this.shifted) pose = pan(pose, -turn[0] * 500 * seconds, turn[1] * 500 * seconds, this.stage.canvas.clientHeight);
      else pose = orbit(pose, turn[0] * angle, -turn[1] * angle);
    }
    const length = Math.hypot(...step);
    if (length > 0) {
      const metres = (this.speed * (this.shifted ? 4 : 1) * seconds) / length;
      pose = walk(pose, step[0] * metres, step[1] * metres, step[2] * metres);
    }
    this.stage.setPose(pose);
  }

  private at(event: { clientX: number; clientY: number }): Finger {
    const rect = this.stage.canvas.getBoundingClientRect();
    return { x: event.clientX - rect.left, y: event.clientY - rect.top };
  }

  private down(event: PointerEvent): void {
    this.flight.stop();
    this.stage.canvas.setPointerCapture(event.pointerId);
    const here = this.at(event);
    this.fingers.set(event.pointerId, here);
    if (this.fingers.size === 1) {
      this.drag = { from: here, shift: event.shiftKey, button: event.button, moved: 0, fingers: 1 };
    } else if (this.drag) {
      this.drag.fingers = this.fingers.size;
    }
  }

  private move(event: PointerEvent): void {
    const before = this.fingers.get(event.pointerId);
    if (!before || !this.drag) return;
    const here = this.at(event), dx = here.x - before.x, dy = here.y - before.y;
    this.drag.moved = Math.max(this.drag.moved, Math.hypot(here.x - this.drag.from.x, here.y - this.drag.from.y));
    const wasClick = this.drag.moved <= kSlop && this.drag.fingers === 1;
    if (wasClick) return;
    const height = this.stage.canvas.clientHeight;
    let pose = this.stage.pose;
    if (this.fingers.size >= 2) {
      const other = [...this.fingers].find(([id]) => id !== event.pointerId)![1];
      // Each finger carries half of the shift, and all of its share of the pinch.
      pose = pan(pose, dx / 2, dy / 2, height);
      const apart = (f: Finger) => Math.max(1, Math.hypot(f.x - other.x, f.y - other.y));
      const place = this.place((here.x + other.x) / 2, (here.y + other.y) / 2);
      pose = zoom(pose, place, apart(before) / apart(here), this.nearest);
    } else if (this.drag.shift || this.drag.button !== 0) {
      pose = pan(pose, dx, dy, height);
    } else if (this.mode === 'walk') {
      pose = look(pose, (-dx / height) * kLookPerHeight * 2, (-dy / height) * kLookPerHeight * 2);
    } else {
      pose = orbit(pose, (-dx / height) * kOrbitPerHeight, (dy / height) * kOrbitPerHeight);
    }
    this.fingers.set(event.pointerId, here);
    this.stage.setPose(pose);
  }

  private up(event: PointerEvent, meant: boolean): void {
    if (!this.fingers.delete(event.pointerId) || !this.drag) return;
    if (this.fingers.size > 0) return;
    const { moved, fingers, button } = this.drag;
    this.drag = null;
    this.wheelPlace = null;
    if (!meant || moved > kSlop || fingers > 1 || button !== 0) return;
    const { x, y } = this.at(event);
    this.options.onClick(x, y, event.shiftKey);
  }

  private wheel(event: WheelEvent): void {
    event.preventDefault();
    this.flight.stop();
    // Lines and pages, where mice count in those.
    const pixels = event.deltaY * (event.deltaMode === 1 ? 16 : event.deltaMode === 2 ? 400 : 1);
    const amount = Math.max(-240, Math.min(240, pixels));
    if (this.mode === 'walk' && !event.ctrlKey) {
      this.setSpeed(this.speed * Math.exp(-amount * 0.0015));
      return;
    }
    const { x, y } = this.at(event);
    // A pinch on a touchpad comes as a wheel with Ctrl, in small steps.
    const factor = Math.exp(amount * (event.ctrlKey ? 0.01 : 0.0015));
    this.stage.setPose(zoom(this.stage.pose, this.place(x, y), factor, this.nearest));
  }

  /** What is seen at a place of the canvas; if nothing is, the place there at the target's distance. */
  private place(x: number, y: number): Vector3 {
    const now = performance.now();
    const last = this.wheelPlace;
    if (last && now - last.time < kWheelPause && Math.hypot(last.x - x, last.y - y) < 40) {
      last.time = now;
      return last.place;
    }
    const { stage } = this, { clientWidth, clientHeight } = stage.canvas;
    const picked = stage.pick(x, y)?.position;
    let place: Vector3;
    if (picked) {
      place = picked.clone();
    } else {
      const ray = new Vector3((2 * x) / clientWidth - 1, 1 - (2 * y) / clientHeight, 0.5)
        .unproject(stage.camera).sub(stage.camera.position).normalize();
      const pose = stage.pose, ahead = forwardOf(pose);
      place = pose.eye.clone().addScaledVector(ray, pose.eye.distanceTo(pose.target) / Math.max(0.1, ray.dot(ahead)));
    }
    this.wheelPlace = { x, y, time: now, place };
    return place;
  }
}

const isZoom = (key: string) => key === '+' || key === '=' || key === '-' || key === '_';
