/** The one or two nodes that are looked at: what is said of them, their lobes and markers in the scene. */
import { Vector3 } from 'three';
import type { Pick } from '../stage/pick';
import type { Stage } from '../stage/stage';
import { kLobeColours } from './colours';
import { LobeInPlace } from './in_place';
import { inspectNode, type Inspection } from './inspection';
import { measureLobe } from './figures';
import { elementOf, Markers } from './markers';

/** 0: the node that was chosen first; 1: the one it is compared with. */
export type Seat = 0 | 1;

/** Share of the scene's diagonal that the longest lobe is; a diffuse one is twice as wide. Chosen by eye. */
const kLength = 0.08;
/** And never more than this share of the distance it is seen from. */
const kLengthOfDistance = 0.22;

interface Taken {
  node: number;
  element: readonly number[];
  /** Peak luminance of the whole lobe. */
  reach: number;
}

export class Selection {
  private readonly taken: [Taken | null, Taken | null] = [null, null];
  private readonly said: [Inspection | null, Inspection | null] = [null, null];
  private readonly lobes: [LobeInPlace, LobeInPlace] = [new LobeInPlace(), new LobeInPlace()];
  private readonly markers: [Markers, Markers];
  /** Both lobes as long as each other, instead of in proportion. */
  private equal = false;
  private size = 1;
  private shownWith = '';
  private readonly listeners = new Set<() => void>();
  private readonly stop: () => void;

  constructor(private readonly stage: Stage, private readonly diagonal: number) {
    this.markers = [0, 1].map((seat) => new Markers(kLobeColours[seat])) as [Markers, Markers];
    for (const seat of [0, 1] as const) stage.overlay.add(this.markers[seat].object, this.lobes[seat].object);
    this.stop = stage.onChange(() => this.follow());
    this.draw();
  }

  /** Of the node in a seat, at the degree that is shown. */
  of(seat: Seat): Inspection | null {
    return this.said[seat];
  }

  get node(): number | null {
    return this.taken[0]?.node ?? null;
  }

  get compared(): number | null {
    return this.taken[1]?.node ?? null;
  }

  get equalPeaks(): boolean {
    return this.equal;
  }

  setEqualPeaks(equal: boolean): void {
    this.equal = equal;
    this.draw();
    this.tell();
  }

  /** What a lobe's values are divided by to be drawn. */
  unitOf(seat: Seat): number {
    return this.equal ? this.taken[seat]?.reach || 1 : 1;
  }

  /** Says whether there is such a node. Null: none. Without a first node there is nothing to compare with, and who
   *  comes is first. */
  take(seat: Seat, what: Pick | number | null): boolean {
    if (what === null) {
      this.taken[seat] = null;
      // Who is left alone is first.
      if (seat === 0) [this.taken[0], this.taken[1]] = [this.taken[1], null];
    } else {
      if (!this.taken[0]) seat = 0;
      const { solution } = this.stage;
      const node = typeof what === 'number' ? what : what.node;
      const whole = inspectNode(solution, node, Infinity);
      if (!whole) return false;
      const element = typeof what === 'number' ? elementOf(solution, node) : what.nodes;
      this.taken[seat] = { node, element, reach: whole.whole ? measureLobe(whole.whole).peak.luminance : 0 };
      if (seat === 0) {
        const distance = this.stage.camera.position.distanceTo(new Vector3(...whole.position));
        this.size = Math.min(kLength * this.diagonal, kLengthOfDistance * distance);
      }
    }
    this.inspect();
    this.draw();
    this.tell();
    return true;
  }

  onChange(listener: () => void): void {
    this.listeners.add(listener);
  }

  dispose(): void {
    this.stop();
    for (const part of [...this.lobes, ...this.markers]) {
      this.stage.overlay.remove(part.object);
      part.dispose();
    }
  }

  private tell(): void {
    for (const listener of this.listeners) listener();
  }

  /** Settings changed, perhaps those that a lobe is shown with. */
  private follow(): void {
    const { degree, exposure, curve } = this.stage.settings;
    const now = `${degree} ${exposure} ${curve}`;
    if (now === this.shownWith) return;
    const degreeBefore = this.shownWith.split(' ')[0];
    this.shownWith = now;
    if (!this.taken[0]) return;
    if (degreeBefore !== String(degree)) {
      this.inspect();
      this.tell();
    }
    this.draw();
  }

  private inspect(): void {
    for (const seat of [0, 1] as const) {
      const taken = this.taken[seat];
      this.said[seat] = taken && inspectNode(this.stage.solution, taken.node, this.stage.settings.degree);
    }
  }

  private draw(): void {
    const { exposure, curve } = this.stage.settings;
    const both = this.taken[1] !== null;
    const most = Math.max(this.taken[0]?.reach ?? 0, this.taken[1]?.reach ?? 0);
    for (const seat of [0, 1] as const) {
      const taken = this.taken[seat], said = this.said[seat];
      this.markers[seat].object.visible = taken !== null;
      this.lobes[seat].object.visible = false;
      if (!taken || !said) continue;
      this.markers[seat].show(this.stage.solution, taken.element, taken.node);
      this.lobes[seat].show(said, {
        size: this.size, reach: this.equal ? taken.reach : most, exposure, curve, tint: both ? kLobeColours[seat] : null,
      });
    }
    this.stage.redraw();
  }
}
