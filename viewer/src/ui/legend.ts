/** What colours mean: a scale with ticks, whose ends can be set, or a list of kinds. */
import type { FalseColour, Quantity } from '../draw/settings';
import type { Stage } from '../stage/stage';
import { h } from './dom';
import { categories, colourAt, type Colour } from '../draw/colour_map';
import { plain, ticks } from './format';
import { quantityTexts } from './quantity_texts';

const css = ([r, g, b]: Colour) => `rgb(${[r, g, b].map((v) => Math.round(255 * v)).join(' ')})`;
const kStops = 24;
const gradient = `linear-gradient(to right, ${Array.from({ length: kStops + 1 }, (_, i) => css(colourAt(i / kStops))).join(', ')})`;

/** Below zero a logarithm has no place: this share of the high end instead. */
const kLeastOfLog = 1e-3;

/** A quantity on a scale that suits the scene, with what of it is given. */
export function scaleFor(
  stage: Stage, quantity: Quantity, given: { low?: number; high?: number; logarithmic?: boolean } = {},
): FalseColour {
  const suits = rounded(stage.range(quantity));
  return sound({ quantity, low: given.low ?? suits.low, high: given.high ?? suits.high, logarithmic: given.logarithmic ?? false });
}

/** Two digits are enough of a range that was measured; unless that makes it empty. */
function rounded({ low, high }: { low: number; high: number }): { low: number; high: number } {
  const [least, most] = [low, high].map((v) => Number(v.toPrecision(2)));
  return least < most ? { low: least, high: most } : { low, high };
}

function sound(scale: FalseColour): FalseColour {
  return scale.logarithmic && !(scale.low > 0) ? { ...scale, low: kLeastOfLog * Math.max(scale.high, 1e-30) } : scale;
}

export class Legend {
  private shown = '';
  private readonly low = this.end('Low end', 'legend-low');
  private readonly high = this.end('High end', 'legend-high');
  private readonly logarithmic: HTMLInputElement;
  private readonly marks = h('div', { className: 'ticks', 'aria-hidden': 'true' });
  private readonly title = h('h2');
  private readonly unit = h('span', { className: 'unit' });
  private readonly scale: HTMLElement;
  private readonly kinds = h('ul', { className: 'kinds' });

  constructor(private readonly element: HTMLElement, private readonly stage: Stage) {
    this.logarithmic = h('input', {
      type: 'checkbox', id: 'legend-log', onchange: () => this.apply({ logarithmic: this.logarithmic.checked }),
    });
    this.scale = h('div', {},
      h('div', { className: 'scale', style: `background: ${gradient}`, role: 'img', 'aria-label': 'Dark blue is low, pale yellow high' }),
      this.marks,
      h('div', { className: 'ends' }, this.low, '–', this.high,
        h('label', { className: 'check', style: 'margin: 0' }, this.logarithmic, 'logarithmic'),
        h('button', { type: 'button', id: 'legend-auto', onclick: () => this.automatic(), title: 'Ends that suit the scene' },
          'automatic')));
    element.replaceChildren(this.title, this.unit, this.scale, this.kinds);
    element.hidden = true;
  }

  followSettings(): void {
    const scale = this.stage.settings.falseColour;
    const now = JSON.stringify(scale);
    if (now === this.shown) return;
    this.shown = now;
    this.element.hidden = scale === null;
    if (!scale) return;
    const { name, unit, kinds } = quantityTexts[scale.quantity];
    this.title.textContent = name[0].toUpperCase() + name.slice(1);
    this.unit.textContent = unit;
    this.scale.hidden = kinds === true;
    this.kinds.hidden = kinds !== true;
    if (scale.quantity === 'kind' || scale.quantity === 'hidden') {
      this.kinds.replaceChildren(...categories[scale.quantity].map(({ name: kind, colour }) =>
        h('li', {}, h('i', { style: `background: ${css(colour)}` }), kind)));
      return;
    }
    const { low, high, logarithmic } = scale;
    this.logarithmic.checked = logarithmic;
    for (const [input, value] of [[this.low, low], [this.high, high]] as const) {
      input.removeAttribute('aria-invalid');
      if (document.activeElement !== input || input.valueAsNumber !== value) input.value = String(Number(value.toPrecision(4)));
    }
    const place = (v: number) =>
      logarithmic ? Math.log(v / low) / Math.log(high / low) : (v - low) / (high - low);
    this.marks.replaceChildren(...ticks(low, high, logarithmic).map((v) =>
      h('span', { style: `--at: ${(100 * place(v)).toFixed(2)}%` }, plain(v))));
  }

  private end(label: string, id: string): HTMLInputElement {
    return h('input', { type: 'number', id, step: 'any', 'aria-label': label, onchange: () => this.ends() });
  }

  private ends(): void {
    const low = this.low.valueAsNumber, high = this.high.valueAsNumber;
    const good = low < high && (low > 0 || !this.logarithmic.checked);
    for (const input of [this.low, this.high]) input.toggleAttribute('aria-invalid', false);
    if (good) this.apply({ low, high });
    else for (const input of [this.low, this.high]) input.setAttribute('aria-invalid', 'true');
  }

  private automatic(): void {
    const scale = this.stage.settings.falseColour;
    if (scale) this.stage.set({ falseColour: scaleFor(this.stage, scale.quantity, { logarithmic: scale.logarithmic }) });
  }

  private apply(change: Partial<FalseColour>): void {
    const scale = this.stage.settings.falseColour;
    if (scale) this.stage.set({ falseColour: sound({ ...scale, ...change }) });
  }
}
