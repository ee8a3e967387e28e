import { h } from './dom';

export interface Slider {
  /** A row: name, slider, value. */
  element: HTMLElement;
  input: HTMLInputElement;
  /** Shows a value without telling. */
  set(value: number): void;
}

/** `words`: the value for people, beside the slider and for screen readers. */
export function slider(options: {
  id: string; label: string; low: number; high: number; step: number;
  words(value: number): string;
  onInput(value: number): void;
}): Slider {
  const { id, label, low, high, step, words, onInput } = options;
  const output = h('output', { htmlFor: id });
  const input = h('input', {
    type: 'range', id, min: low, max: high, step, oninput: () => {
      show(input.valueAsNumber);
      onInput(input.valueAsNumber);
    },
  });
  // `value` before min and max would be cut to 0..100.
  function show(value: number): void {
    output.textContent = words(value);
    input.setAttribute('aria-valuetext', words(value));
    input.style.setProperty('--share', `${(100 * (Math.min(high, Math.max(low, value)) - low)) / (high - low)}%`);
  }
  return {
    input,
    element: h('div', { className: 'row' }, h('label', { htmlFor: id }, label), input, output),
    set(value) {
      input.value = String(value);
      show(value);
    },
  };
}
