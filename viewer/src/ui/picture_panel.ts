/** How the scene is shown: exposure, curve, false colour, edges, backs. */
import type { Solution } from '../solution/solution';
import { quantities } from '../stage/address';
import { toneCurves, type Quantity, type ToneCurve } from '../draw/settings';
import type { Stage } from '../stage/stage';
import { h } from './dom';
import { signed } from './format';
import { quantityTexts } from './quantity_texts';
import { slider, type Slider } from './slider';

const curveNames: Record<ToneCurve, string> = { srgb: 'sRGB', reinhard: 'Reinhard', filmic: 'Filmic' };

/** The exposure that shows most of a scene below 1: where a page starts that is asked for no other. */
export function automaticExposure(solution: Solution): number {
  const stops = Math.log2(solution.exposureScale);
  return Number.isFinite(stops) ? Math.round(stops * 10) / 10 : 0;
}

export class PicturePanel {
  readonly element: HTMLElement;
  private readonly exposure: Slider;
  private readonly curves: Map<ToneCurve, HTMLInputElement>;
  private readonly show: HTMLSelectElement;
  private readonly wireframe: HTMLButtonElement;
  private readonly backs: HTMLButtonElement;

  constructor(private readonly stage: Stage, onShow: (quantity: Quantity | null) => void) {
    const { solution } = stage;
    const automatic = automaticExposure(solution);
    this.exposure = slider({
      id: 'exposure', label: 'Exposure', low: Math.min(-10, Math.floor(automatic - 6)), high: Math.max(10, Math.ceil(automatic + 6)),
      step: 0.05, words: (value) => `${signed(value, 2)} EV`, onInput: (exposure) => stage.set({ exposure }),
    });
    this.exposure.input.title = 'Stops, as of “lobe render --exposure”; double-click: what suits the scene';
    this.exposure.input.addEventListener('dblclick', () => stage.set({ exposure: automatic }));

    this.curves = new Map(toneCurves.map((curve) => [curve, h('input', {
      type: 'radio', name: 'curve', value: curve, onchange: () => stage.set({ curve }),
    })]));
    this.show = h('select', {
      id: 'show', onchange: () => onShow(this.show.value === '' ? null : (this.show.value as Quantity)),
    }, h('option', { value: '' }, 'the picture'), ...quantities.map((quantity) => {
      const why = stage.whyNot(quantity);
      return h('option', { value: quantity, disabled: why !== null, title: why ?? undefined },
        quantityTexts[quantity].name + (why ? ' (not in this file)' : ''));
    }));
    const toggle = (id: string, label: string, title: string, onclick: () => void) =>
      h('button', { type: 'button', id, title, 'aria-pressed': 'false', onclick }, label);
    this.wireframe = toggle('wireframe', 'Elements', 'Edges of the elements (X)', () => stage.set({ wireframe: !stage.settings.wireframe }));
    this.backs = toggle('backs', 'See through backs', 'Look into a room from outside (B)', () => stage.set({ seeThroughBacks: !stage.settings.seeThroughBacks }));

    this.element = h('section', { 'aria-labelledby': 'picture-title' },
      h('h2', { id: 'picture-title' }, 'Picture'),
      this.exposure.element,
      h('div', { className: 'row wide' }, h('span', { className: 'label', id: 'curve-label' }, 'Curve'),
        h('div', { className: 'segments', role: 'radiogroup', 'aria-labelledby': 'curve-label' },
          ...[...this.curves].map(([curve, input]) => h('label', {}, input, curveNames[curve])))),
      h('div', { className: 'row wide' }, h('label', { htmlFor: 'show' }, 'Show'), this.show),
      h('div', { className: 'switches' }, this.wireframe, this.backs));
  }

  followSettings(): void {
    const { exposure, curve, falseColour, wireframe, seeThroughBacks } = this.stage.settings;
    this.exposure.set(exposure);
    this.curves.get(curve)!.checked = true;
    this.show.value = falseColour?.quantity ?? '';
    this.wireframe.setAttribute('aria-pressed', String(wireframe));
    this.backs.setAttribute('aria-pressed', String(seeThroughBacks));
  }
}
