import type { KeyGroup } from '../stage/keys';
import { h } from './dom';

/** Keys drawn as keys; what is between them says whether they are pressed together. */
function keys(shown: string): (HTMLElement | string)[] {
  return shown.split(/( \/ | \+ | )/).map((part) => {
    if (part === ' / ' || part === ' ') return ' ';
    return part === ' + ' ? h('span', { className: 'with' }, '+') : h('kbd', {}, part);
  });
}

/** The dialog that lists the keys. */
export function fillHelp(dialog: HTMLDialogElement, groups: readonly KeyGroup[]): void {
  dialog.replaceChildren(
    h('header', {}, h('h2', { id: 'keys-title' }, 'Keys and mouse'),
      h('button', { type: 'button', className: 'quiet', 'aria-label': 'Close', onclick: () => dialog.close() }, '✕')),
    h('div', { className: 'groups' }, ...groups.map((group) =>
      h('section', {}, h('h3', {}, group.title),
        h('dl', {}, ...group.keys.filter((key) => key.shown !== '').flatMap((key) => [h('dt', {}, ...keys(key.shown)), h('dd', {}, key.does)]))))));
  // A click beside it.
  dialog.onclick = (event) => {
    if (event.target === dialog) dialog.close();
  };
}
