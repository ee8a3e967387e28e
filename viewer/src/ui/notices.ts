/** What the page says besides the picture: how far loading is, what is wrong, what just happened. */
import { h, region } from './dom';

export class Loading {
  private readonly element = region('loading');
  private readonly words = region('loading-words');
  private readonly share = region<HTMLProgressElement>('loading-share');

  /** Undefined: nobody knows how long. */
  show(title: string, share?: number): void {
    this.element.hidden = false;
    const whole = share !== undefined && share >= 1;
    this.words.textContent = whole ? `${title}: reading the lobes` :
      `${title}${share === undefined ? '' : `, ${Math.floor(100 * share)} %`}`;
    if (share === undefined || whole) this.share.removeAttribute('value');
    else this.share.value = share;
  }

  hide(): void {
    this.element.hidden = true;
  }
}

/** One sentence, and what to do. `dismissable`: there is a picture to go back to. */
export function showProblem(sentence: string, open: () => void, dismissable: boolean): void {
  const element = region('problem');
  const close = () => element.replaceChildren();
  element.classList.toggle('over', dismissable);
  const first = h('button', { type: 'button', onclick: open }, 'Open a solution…');
  element.replaceChildren(h('div', {},
    h('h2', {}, 'The solution cannot be shown'),
    h('p', {}, sentence),
    h('p', { className: 'what' }, 'Drop a file that “lobe solve” wrote onto this page, or open one.'),
    h('div', { className: 'actions' }, first, dismissable
      ? h('button', { type: 'button', onclick: close }, 'Back')
      : h('button', { type: 'button', onclick: () => location.reload() }, 'Try again'))));
  first.focus();
}

export function hideProblem(): void {
  region('problem').replaceChildren();
}

let fading = 0;
/** Milliseconds that words stay: a while, and what reading takes. */
const kGlance = 1600, kALetter = 50;

/** Says what a key or button did; for eyes and for screen readers. */
export function say(words: string): void {
  const element = region('status');
  element.textContent = words;
  element.classList.add('said');
  clearTimeout(fading);
  fading = window.setTimeout(() => element.classList.remove('said'), Math.max(kGlance, kALetter * words.length));
}
