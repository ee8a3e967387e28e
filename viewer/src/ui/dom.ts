/** Elements by one call; what is not a property is an attribute. */

type Child = Node | string | null | undefined | false;
type Values = Record<string, unknown>;

export function h<K extends keyof HTMLElementTagNameMap>(
  tag: K, values: Values = {}, ...children: Child[]
): HTMLElementTagNameMap[K] {
  const element = document.createElement(tag);
  for (const [name, value] of Object.entries(values)) {
    if (value === undefined || value === null || value === false) continue;
    if (name.startsWith('on')) element.addEventListener(name.slice(2), value as EventListener);
    else if (name in element && !name.includes('-') && name !== 'list') (element as unknown as Values)[name] = value;
    else element.setAttribute(name, value === true ? '' : String(value));
  }
  element.append(...children.filter((c): c is Node | string => c !== null && c !== undefined && c !== false));
  return element;
}

/** Markup of our own making: icons, plots. */
export function markup(text: string): Element {
  const template = document.createElement('template');
  template.innerHTML = text;
  return template.content.firstElementChild!;
}

/** An element of index.html. */
export function region<T extends HTMLElement = HTMLElement>(id: string): T {
  return document.getElementById(id) as T;
}

/** Hands the browser a file to keep. */
export function download(name: string, blob: Blob): void {
  const address = URL.createObjectURL(blob);
  h('a', { href: address, download: name }).click();
  setTimeout(() => URL.revokeObjectURL(address), 60_000);
}
