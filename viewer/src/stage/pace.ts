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

  /** `drawFinely` is called when what was last drawn coarsely stands. */
  constructor(private readonly drawFinely: () => void) {}

  /** Before a frame that was asked for `lateness` milliseconds ago: whether to draw it coarsely. A browser calls late
   *  when frames before are not done yet. */
  isCoarse(lateness: number): boolean {
    this.slow = lateness > (this.slow ? kQuick : kSlow);
    clearTimeout(this.timer);
    if (this.slow) this.timer = setTimeout(this.drawFinely, kStands) as unknown as number;
    return this.slow;
  }
}
