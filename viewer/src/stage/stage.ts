/**
 * The scene on the canvas: camera, settings, what is drawn when. The panels know it by this class alone; how lobes get
 * to the screen is draw/'s.
 */
import { Group, PerspectiveCamera, Vector2, Vector3, Raycaster, type Mesh, type Object3D } from 'three';
import type { Solution } from '../solution/solution';
import { Picture, type Captured, type DrawStats } from '../draw/picture';
import { whyNot } from '../draw/quantities';
import { Pace } from './pace';
import { pickAlong, type Pick } from './pick';
import { defaultSettings, type Quantity, type Settings } from '../draw/settings';

/** Where the eye is, what it turns about. */
export interface Pose {
  eye: Vector3;
  target: Vector3;
  up: Vector3;
  /** Vertical, degrees. */
  fov: number;
}

export class Stage {
  readonly camera = new PerspectiveCamera(50, 1, 0.01, 1000);
  /** What the eye turns about, and what the wheel goes to. */
  readonly target = new Vector3();
  /** Drawn last, in display colours, with the scene's depth: lobes, markers. */
  readonly overlay = new Group();
  private readonly picture: Picture;
  private current: Settings = { ...defaultSettings };
  /** Of requestAnimationFrame; 0: none is asked for. */
  private asked = 0;
  private readonly pace = new Pace(() => this.drawNow());
  private readonly listeners = new Set<() => void>();
  private readonly observer = new ResizeObserver(() => this.resize());
  private readonly away = new AbortController();
  private fitted = '';

  /** Throws Problem where the browser cannot draw. */
  constructor(readonly canvas: HTMLCanvasElement, readonly solution: Solution) {
    this.picture = new Picture(canvas, solution, () => this.redraw());
    // While the context is lost: in the next one three would delete by names of this one.
    canvas.addEventListener('webglcontextlost', () => this.overlay.traverse(forget), { signal: this.away.signal });
    this.observer.observe(canvas);
    this.watchPixelRatio();
    this.fit();
    this.redraw();
  }

  /** Nothing is drawn any more, nor asked for. */
  dispose(): void {
    this.away.abort();
    this.observer.disconnect();
    cancelAnimationFrame(this.asked);
    this.pace.stop();
    this.listeners.clear();
  }

  get settings(): Readonly<Settings> {
    return this.current;
  }

  set(change: Partial<Settings>): void {
    this.current = { ...this.current, ...change };
    this.changed();
  }

  get pose(): Pose {
    return { eye: this.camera.position.clone(), target: this.target.clone(), up: this.camera.up.clone(), fov: this.camera.fov };
  }

  setPose(pose: Partial<Pose>): void {
    if (pose.eye) this.camera.position.copy(pose.eye);
    if (pose.target) this.target.copy(pose.target);
    if (pose.up) this.camera.up.copy(pose.up);
    if (pose.fov) this.camera.fov = pose.fov;
    this.camera.lookAt(this.target);
    this.camera.updateProjectionMatrix();
    this.changed();
  }

  /** Called after every change of pose, settings or size; returns how to stop that. */
  onChange(listener: () => void): () => void {
    this.listeners.add(listener);
    return () => this.listeners.delete(listener);
  }

  /** Draws once, soon; coarsely for now, where frames come late. Nothing is drawn while nothing changes. */
  redraw(): void {
    if (this.asked || this.away.signal.aborted) return;
    const since = performance.now();
    this.asked = requestAnimationFrame(() => {
      this.asked = 0;
      this.draw(performance.now() - since);
    });
  }

  /** Draws at once, finely: for screenshots and measurements. */
  drawNow(): void {
    this.pace.drawn(this.picture.draw(this.camera, this.current, this.overlay));
  }

  /** The present pose at that size, in pixels, without the overlay unless asked for. The wires are settings', and come
   *  along. */
  capture(width: number, height: number, { overlay = false } = {}): Captured {
    try {
      return this.picture.capture(this.camera, this.current, overlay ? this.overlay : null, width, height);
    } finally {
      this.drawNow();
    }
  }

  /** What a quantity lacks to be shown in false colours, in a sentence; null: nothing. */
  whyNot(quantity: Quantity): string | null {
    return whyNot(this.solution, quantity);
  }

  /** A scale for a quantity, in its unit: the 2nd to the 98th percentile of the nodes. */
  range(quantity: Quantity): { low: number; high: number } {
    return this.picture.range(quantity);
  }

  /** What is seen at a place of the canvas, CSS pixels from its top left. */
  pick(x: number, y: number): Pick | null {
    const rect = this.canvas.getBoundingClientRect();
    const caster = new Raycaster();
    caster.setFromCamera(new Vector2((2 * x) / rect.width - 1, 1 - (2 * y) / rect.height), this.camera);
    return pickAlong(this.solution, caster.ray, this.current.seeThroughBacks);
  }

  get stats(): Readonly<DrawStats> {
    return this.picture.stats;
  }

  private draw(lateness?: number): void {
    const coarsely = this.pace.isCoarse(lateness);
    this.pace.drawn(this.picture.draw(this.camera, this.current, this.overlay, coarsely, false));
  }

  /** Draws at once: sizes are observed after the frame's other work, and a canvas of a new size is black. */
  private resize(): void {
    if (!this.fit()) return;
    this.draw();
    this.tell();
  }

  /** Says whether the size is a new one. */
  private fit(): boolean {
    const { clientWidth: width, clientHeight: height } = this.canvas, { devicePixelRatio } = window;
    const now = `${width} ${height} ${devicePixelRatio}`;
    if (width === 0 || height === 0 || now === this.fitted) return false;
    this.fitted = now;
    this.picture.resize(width, height, devicePixelRatio);
    this.camera.aspect = width / height;
    this.camera.updateProjectionMatrix();
    return true;
  }

  /** It changes with the screen that the window is on, and with the browser's zoom. */
  private watchPixelRatio(): void {
    const { signal } = this.away;
    matchMedia(`(resolution: ${window.devicePixelRatio}dppx)`).addEventListener('change', () => {
      this.resize();
      this.watchPixelRatio();
    }, { once: true, signal });
  }

  private changed(): void {
    this.tell();
    this.redraw();
  }

  private tell(): void {
    for (const listener of this.listeners) listener();
  }
}

function forget(object: Object3D): void {
  const { geometry, material } = object as Partial<Mesh>;
  geometry?.dispose();
  for (const one of [material ?? []].flat()) one.dispose();
}
