import { between } from './moves';
import type { Pose, Stage } from './stage';

/** Short enough not to be waited for, long enough to see where one goes; milliseconds, chosen. */
const kDuration = 420;

/** Takes the stage to a pose, smoothly; at once for who has asked for less motion. */
export class Flight {
  private frame = 0;
  /** Where it ends; null while nothing flies. */
  destination: Pose | null = null;

  constructor(private readonly stage: Stage) {}

  to(pose: Pose): void {
    this.stop();
    if (matchMedia('(prefers-reduced-motion: reduce)').matches) {
      this.stage.setPose(pose);
      return;
    }
    const from = this.stage.pose, start = performance.now();
    this.destination = pose;
    const step = (now: number) => {
      const t = Math.max(0, (now - start) / kDuration);
      this.stage.setPose(between(from, pose, t));
      if (t < 1) this.frame = requestAnimationFrame(step);
      else this.destination = null;
    };
    this.frame = requestAnimationFrame(step);
  }

  /** Where the eye is, if somebody takes over. */
  stop(): void {
    cancelAnimationFrame(this.frame);
    this.destination = null;
  }
}
