/** What keys do: one list, which the page obeys and its help shows. */

export interface Key {
  /** As event.key says it; letters in the case that Shift makes of them. */
  keys: readonly string[];
  /** For people, keys between " + " and " / " and blanks; empty: said with another. */
  shown: string;
  does: string;
  /** None: said in the help, done by Controls. */
  run?: (event: KeyboardEvent) => void;
  /** Only while the scene has the focus, since buttons and sliders use the key too. */
  onCanvas?: boolean;
}

export interface KeyGroup {
  title: string;
  keys: readonly Key[];
}

const kTyping = 'input[type="number"], input[type="text"], select, textarea';

/** The key that an event means, or null: if somebody types, or a dialog is open, or the browser is meant. */
export function findKey(groups: readonly KeyGroup[], event: KeyboardEvent): Key | null {
  if (event.ctrlKey || event.metaKey || event.altKey || isTaken(event)) return null;
  const onCanvas = isOnCanvas(event);
  for (const { keys } of groups) {
    for (const key of keys) {
      if (key.run && key.keys.includes(event.key) && (onCanvas || !key.onCanvas)) return key;
    }
  }
  return null;
}

export function isTaken(event: KeyboardEvent): boolean {
  if (document.querySelector('dialog[open]')) return true;
  return event.target instanceof Element && event.target.matches(kTyping);
}

/** Nothing else has the focus that would want arrows or Enter. */
export function isOnCanvas(event: KeyboardEvent): boolean {
  return event.target === document.body || event.target instanceof HTMLCanvasElement;
}
