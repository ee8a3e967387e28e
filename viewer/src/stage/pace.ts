/** A frame that comes this much later than it was asked for is slow, milliseconds: ten a second. (chosen) */
const kSlow = 100;
/** Coarse frames have a quarter of the pixels: where they come this soon, fine ones will do. */
const kQuick = kSlow / 4;
/** Nothing has moved for so long: it stands. (chosen) */
const kStands = 200;

/**
 * Whether to draw finely, or soon: where the graphics card does not keep up, pictures are coarse while something moves,
 * and fine once it stands.
 */
export class Pace {
  private slow = false;
  private timer = 0;

  /** `finish` is called when what was last drawn, and left unfinished, stands. */
  constructor(private readonly finish: () => void) {}

  /** Before a frame that was asked for `lateness` milliseconds ago: whether to draw it coarsely. A browser calls late
   *  when frames before are not done yet. Without lateness, what was not asked for before: as the last one. */
  isCoarse(lateness?: number): boolean {
    if (lateness !== undefined) this.slow = lateness > (this.slow ? kQuick : kSlow);
    return this.slow;
  }

  /** After every frame: whether there is nothing left to finish. */
  drawn(finished: boolean): void {
    this.stop();
    if (!finished) this.timer = setTimeout(this.finish, kStands) as unknown as number;
  }

  stop(): void {
    clearTimeout(this.timer);
  }
}
