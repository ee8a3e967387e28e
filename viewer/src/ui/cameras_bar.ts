/** Named cameras, all of the scene, and the two ways to move. */
import type { Solution } from '../solution/solution';
import type { Mode } from '../stage/controls';
import { h } from './dom';
import { number } from './format';

export interface CamerasActions {
  camera(index: number): void;
  all(): void;
  mode(mode: Mode): void;
}

export class CamerasBar {
  private readonly cameras: HTMLButtonElement[];
  private readonly modes: Record<Mode, HTMLButtonElement>;
  private readonly speed = h('span', { className: 'speed', hidden: true, title: 'The wheel changes it, Shift is four times as fast' });

  constructor(element: HTMLElement, solution: Solution, does: CamerasActions) {
    const button = (title: string, onclick: () => void, ...words: (string | Node | false)[]) =>
      h('button', { type: 'button', title, 'aria-pressed': 'false', onclick }, ...words);
    this.cameras = solution.cameras.map(({ name }, i) =>
      button(`Camera ${name}`, () => does.camera(i), i < 9 && h('span', { className: 'key', 'aria-hidden': 'true' }, String(i + 1)), name));
    const all = button('All of the scene', () => does.all(), 'All');
    all.removeAttribute('aria-pressed');
    this.modes = {
      orbit: button('Turn about what is seen (V)', () => does.mode('orbit'), 'Orbit'),
      walk: button('Walk: W A S D, Q E (V)', () => does.mode('walk'), 'Walk'),
    };
    element.replaceChildren(
      h('div', { className: 'group', role: 'group', 'aria-label': 'Cameras' }, ...this.cameras, all),
      h('div', { className: 'group', role: 'group', 'aria-label': 'Ways to move' }, this.modes.orbit, this.modes.walk, this.speed));
  }

  /** Null: none of them. */
  setCamera(index: number | null): void {
    this.cameras.forEach((button, i) => button.setAttribute('aria-pressed', String(i === index)));
  }

  setMode(mode: Mode, speed: number): void {
    for (const each of ['orbit', 'walk'] as const) this.modes[each].setAttribute('aria-pressed', String(each === mode));
    this.speed.hidden = mode !== 'walk';
    this.speed.textContent = `${number(speed, 2)} m/s`;
  }
}
