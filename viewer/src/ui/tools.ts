import { h, markup } from './dom';

const icons = {
  open: '<path d="M3 6.5V15a1.5 1.5 0 0 0 1.5 1.5h11A1.5 1.5 0 0 0 17 15V7.5A1.5 1.5 0 0 0 15.5 6H10L8 3.5H4.5A1.5 1.5 0 0 0 3 5z"/>',
  screenshot: '<path d="M3 7.5A1.5 1.5 0 0 1 4.500 6H6.500l1.200-2h4.600l1.200 2h2A1.500 1.500 0 0 1 17 7.500v7A1.500 1.500 0 0 1 15.500 16h-11A1.500 1.500 0 0 1 3 14.500z"/><circle cx="10" cy="10.800" r="2.700"/>',
  help: '<path d="M7.500 7.500a2.500 2.500 0 1 1 3.600 2.200c-.8.5-1.100 1-1.100 2"/><circle cx="10" cy="14.600" r=".5"/><circle cx="10" cy="10" r="7.500"/>',
  panel: '<rect x="3" y="4" width="14" height="12" rx="1.500"/><path d="M12 4v12"/>',
} as const;

export interface ToolsActions {
  open(): void;
  screenshot(): void;
  help(): void;
  panel(): void;
}

/** The buttons at the top right; gives the one that shows and hides the panel. */
export function fillTools(element: HTMLElement, does: ToolsActions): HTMLButtonElement {
  const button = (id: string, icon: keyof typeof icons, label: string, onclick: () => void) =>
    h('button', { type: 'button', id, title: label, 'aria-label': label, onclick },
      markup(`<svg viewBox="0 0 20 20" aria-hidden="true">${icons[icon]}</svg>`));
  const panel = button('panel-toggle', 'panel', 'Show or hide the panel (P)', () => does.panel());
  panel.setAttribute('aria-controls', 'panel');
  element.replaceChildren(
    button('open', 'open', 'Open a solution (O)', () => does.open()),
    button('screenshot', 'screenshot', 'Save the picture as PNG', () => does.screenshot()),
    button('help', 'help', 'Keys and mouse (?)', () => does.help()),
    panel);
  return panel;
}
