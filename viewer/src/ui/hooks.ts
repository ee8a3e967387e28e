/** `window.lobe`: for tests and for pages that script the viewer (README.md). */
import type { LobeJson } from '../inspect/inspection';
import type { Solution } from '../solution/solution';
import type { Stage } from '../stage/stage';
import type { Page } from './page';

export interface LobeHooks {
  /** Null until `ready`. */
  readonly stage: Stage | null;
  readonly solution: Solution | null;
  select(node: number | null): void;
  compare(node: number | null): void;
  figures(node: number): LobeJson;
  /** The solution is there, and drawn once; rejects with the sentence that the page shows. */
  ready: Promise<void>;
}

declare global {
  interface Window {
    lobe: LobeHooks;
  }
}

const twoFrames = () =>
  new Promise<void>((resolve) => requestAnimationFrame(() => requestAnimationFrame(() => resolve())));

export function offerHooks(opened: Promise<void>, page: () => Page | null): void {
  const open = () => {
    const now = page();
    if (!now) throw new Error('no solution is open yet; await lobe.ready');
    return now;
  };
  const ready = opened.then(twoFrames);
  // The page has said what is wrong; who does not ask is not to be bothered again.
  ready.catch(() => {});
  window.lobe = {
    get stage() {
      return page()?.stage ?? null;
    },
    get solution() {
      return page()?.solution ?? null;
    },
    select: (node) => open().select(node),
    compare: (node) => open().compare(node),
    figures: (node) => open().figures(node),
    ready,
  };
}
