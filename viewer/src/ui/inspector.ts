/** The lobe section of the panel: the degree, and what is said of the one or two nodes that are looked at. */
import { toWorld } from '../sh/frame';
import type { Inspection } from '../inspect/inspection';
import type { Selection, Seat } from '../inspect/selection';
import type { Stage } from '../stage/stage';
import { h } from './dom';
import { saveJson, saveSvg } from './export';
import { number, percent, vector } from './format';
import { slicesFigure, spectrumFigure } from './plots';
import { slider, type Slider } from './slider';

export interface InspectorActions {
  /** The next click chooses the node to compare with. */
  pin(): void;
  focus(): void;
  clear(seat: Seat): void;
}

const kinds = {
  none: 'diffuse',
  lobe: 'gloss as a lobe',
  sharp: 'gloss sharper than its lobe',
  mirror: 'ideal mirror',
} as const;

/** What a reader should know before trusting the lobe. */
function notesOf(i: Inspection): string[] {
  const notes: string[] = [];
  if (!i.whole) {
    notes.push(i.kind === 'mirror'
      ? 'An ideal mirror: it shows what it reflects, and keeps no lobe.'
      : 'Black: this surface reflects nothing, so there is no lobe.');
  } else if (i.kind === 'mirror') {
    notes.push('Besides this lobe the surface is an ideal mirror; what it mirrors is not part of the lobe.');
  } else if (i.kind === 'sharp') {
    notes.push('The gloss is sharper than this lobe can hold; “lobe render” gathers it anew.');
  }
  if (i.hidden) notes.push('Hidden: the node lies inside something and has no weight in the picture.');
  return notes;
}

/** Numbers of a vector stand apart without commas, so that two columns of them fit. */
const kBetween = '\u2002';

interface Row {
  name: string;
  /** Small, beneath the name. */
  unit?: string;
  figure: string;
  of(i: Inspection): { raw: unknown; words: string | Node; small?: string } | null;
}

function rgb(values: readonly number[], figure?: string): HTMLElement {
  const colours = ['#ff7a6b', '#6fd07f', '#7aa5ff'], names = ['red', 'green', 'blue'];
  return h('span', { className: 'rgb', 'data-figure': figure, 'data-value': figure && JSON.stringify(values) },
    ...values.map((v, c) => h('span', { style: `--c: ${colours[c]}`, title: names[c] }, number(v))));
}

const triple = (v: readonly number[]) => h('span', { className: 'triple' }, vector(v, kBetween));

const rows: readonly Row[] = [
  {
    name: 'Flux', unit: 'W/m²', figure: 'flux',
    of: (i) => i.figures && { raw: i.figures.flux, words: rgb(i.figures.flux) },
  },
  {
    name: 'Peak', unit: 'W/(m² sr)', figure: 'peak',
    of: (i) => i.figures && {
      raw: i.figures.peak.luminance, words: rgb(i.figures.peak.radiance, 'peakRadiance'),
      small: `luminance ${number(i.figures.peak.luminance)}`,
    },
  },
  {
    name: 'Direction', unit: 'of the peak: θ, φ; world', figure: 'peakDirection',
    of: (i) => {
      if (!i.figures) return null;
      const { peak } = i.figures, world = toWorld(i.frame, peak.direction);
      return { raw: world, words: `${peak.thetaDegrees.toFixed(1)}°, ${peak.phiDegrees.toFixed(1)}°`, small: vector(world, kBetween) };
    },
  },
  {
    name: 'Negative', unit: 'share of the flux', figure: 'negative',
    of: (i) => i.figures && { raw: i.figures.negative, words: percent(i.figures.negative) },
  },
  {
    name: 'Degree', unit: 'shown, of l_max', figure: 'lMax',
    of: ({ whole, shown }) => whole && shown && {
      raw: whole.lMax, words: shown.lMax < whole.lMax ? `${shown.lMax} of ${whole.lMax}` : String(whole.lMax),
    },
  },
  {
    name: 'Cut error', unit: 'relative, L2', figure: 'error',
    of: (i) => i.whole && { raw: i.error, words: percent(i.error) },
  },
  { name: 'Position', unit: 'm', figure: 'position', of: (i) => ({ raw: i.position, words: triple(i.position) }) },
  { name: 'Normal', figure: 'normal', of: (i) => ({ raw: i.frame.z, words: triple(i.frame.z) }) },
];

const seatName = ['first', 'second'] as const;

function cell(i: Inspection, row: Row, seat: Seat): HTMLElement {
  const said = row.of(i);
  return h('td', {
    className: seatName[seat], 'data-figure': row.figure, 'data-seat': seatName[seat],
    'data-value': said ? JSON.stringify(said.raw) : undefined,
  }, said ? said.words : '–', said?.small ? h('small', {}, said.small) : null);
}

function table(inspections: readonly Inspection[]): HTMLElement {
  const two = inspections.length > 1;
  return h('table', { className: two ? 'figures two' : 'figures' },
    two && h('thead', {}, h('tr', {}, h('th', {}), ...inspections.map((i, seat) =>
      h('th', { scope: 'col', className: seatName[seat] }, `node ${i.node}`)))),
    h('tbody', {}, ...rows
      .filter((row) => inspections.some((i) => row.of(i)))
      .map((row) => h('tr', {},
        h('th', { scope: 'row' }, row.name, row.unit ? h('small', {}, row.unit) : null),
        ...inspections.map((i, seat) => cell(i, row, seat as Seat))))));
}

export class Inspector {
  readonly element: HTMLElement;
  readonly degree: Slider;
  private readonly hint = h('p', { className: 'hint' });
  private readonly seats: [HTMLElement, HTMLElement];
  private readonly notes = h('div');
  private readonly body = h('div');
  private readonly compare: HTMLButtonElement;
  private readonly saves: HTMLButtonElement[];
  private readonly actions: HTMLElement;
  private readonly equal: HTMLInputElement;
  private readonly equalRow: HTMLElement;

  constructor(
    private readonly stage: Stage, private readonly selection: Selection, private readonly lMax: number,
    private readonly does: InspectorActions,
  ) {
    this.degree = slider({
      id: 'degree', label: 'Degree', low: 0, high: Math.max(1, lMax), step: 1,
      words: (value) => (lMax === 0 ? 'all diffuse' : value >= lMax ? `whole (${lMax})` : `${value} of ${lMax}`),
      onInput: (degree) => stage.set({ degree }),
    });
    this.degree.input.disabled = lMax === 0;
    this.degree.input.title = 'Lobes are cut at this degree; their flux is kept';
    this.seats = [this.seat(0), this.seat(1)];
    const button = (words: string, title: string, onclick: () => void, id?: string) =>
      h('button', { type: 'button', id, title, onclick }, words);
    this.compare = button('Compare', 'Keep this node, and choose another (C)', () => does.pin());
    this.saves = [
      button('JSON', 'Figures and coefficients of the lobe', () => saveJson(stage.solution, selection), 'save-json'),
      button('SVG', 'The slices as a drawing', () => saveSvg(stage.solution, selection), 'save-svg'),
    ];
    this.equal = h('input', { type: 'checkbox', onchange: () => selection.setEqualPeaks(this.equal.checked) });
    this.equalRow = h('label', { className: 'check' }, this.equal, 'Draw both by their own peak');
    this.actions = h('div', { className: 'actions' },
      this.compare, button('Focus', 'Go there (F)', () => does.focus()), ...this.saves);
    this.element = h('section', { 'aria-labelledby': 'lobes-title' },
      h('h2', { id: 'lobes-title' }, 'Lobes'), this.degree.element, this.hint,
      h('div', { className: 'who' }, ...this.seats), this.notes, this.actions, this.equalRow, this.body);
    selection.onChange(() => this.show());
    this.show();
  }

  /** While the next click is for comparing. */
  setPinned(pinned: boolean): void {
    this.compare.setAttribute('aria-pressed', String(pinned));
    this.show();
  }

  /** Brings it into the panel's view, where that is small. */
  reveal(): void {
    const panel = this.element.parentElement!;
    const top = this.element.getBoundingClientRect().top - panel.getBoundingClientRect().top;
    if (panel.clientHeight < 0.5 * window.innerHeight) panel.scrollBy({ top });
  }

  followSettings(): void {
    this.degree.set(Math.min(this.stage.settings.degree, Math.max(1, this.lMax)));
  }

  private seat(seat: Seat): HTMLElement {
    return h('div', { className: seatName[seat] });
  }

  private show(): void {
    const first = this.selection.of(0), second = this.selection.of(1);
    const pinned = this.compare.getAttribute('aria-pressed') === 'true';
    this.fill(0, first);
    this.fill(1, second);
    this.hint.textContent = !first
      ? 'Click a surface, and its lobe stands where you clicked: the light that leaves there, by direction.'
      : pinned && !second ? 'Now choose the node to compare with.' : '';
    this.hint.hidden = this.hint.textContent === '';
    this.actions.hidden = !first;
    this.equalRow.hidden = !first?.whole || !second?.whole;
    this.equal.checked = this.selection.equalPeaks;
    const said = [first, second].filter((i): i is Inspection => i !== null);
    this.notes.replaceChildren(...said.flatMap((i) => notesOf(i).map((words) =>
      h('p', { className: 'note' }, said.length > 1 ? `Node ${i.node}: ${words}` : words))));
    this.body.replaceChildren();
    if (said.some((i) => i.whole)) this.body.append(slicesFigure(this.selection));
    if (said.length > 0) this.body.append(table(said));
    if (said.some((i) => (i.whole?.lMax ?? 0) > 0)) {
      this.body.append(spectrumFigure(this.selection, this.stage.settings.degree));
    }
    for (const save of this.saves) save.disabled = !said.some((i) => i.whole);
  }

  private fill(seat: Seat, i: Inspection | null): void {
    const element = this.seats[seat];
    element.hidden = i === null;
    if (!i) return;
    const figure = (name: string, raw: string | number, words: string) =>
      h('span', { 'data-figure': name, 'data-seat': seatName[seat], 'data-value': String(raw) }, words);
    // The button that was pressed may be the one that is replaced.
    const hadFocus = element.contains(document.activeElement);
    element.replaceChildren(
      h('span', { className: 'dot' }),
      h('div', {},
        h('strong', {}, figure('node', i.node, `Node ${i.node}`)),
        h('small', {}, figure('surface', i.surface, i.surface), i.side === 'back' ? ', its back' : '', ' · ',
          figure('material', i.material, i.material), ' · ', figure('kind', i.kind, kinds[i.kind]))),
      h('button', {
        type: 'button', className: 'quiet', 'aria-label': `Leave node ${i.node}`, title: 'Leave it (Esc)',
        onclick: () => this.does.clear(seat),
      }, '✕'));
    if (hadFocus) element.querySelector('button')!.focus();
  }
}
