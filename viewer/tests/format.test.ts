import { describe, expect, it } from 'vitest';
import { metres, number, percent, signed, stem, ticks } from '../src/ui/format';

describe('Numbers for people', () => {
  it.each([[0, '0'], [0.63123, '0.631'], [-12.5, '−12.5'], [1234.5, '1230'], [99999, '100000'], [2.5e-5, '2.50·10⁻⁵'], [3e7, '3.00·10⁷'],
    [NaN, '–'], [-Infinity, '−∞']])('%f is %s', (value, text) => {
    expect(number(value)).toBe(text);
  });

  it('have no minus zero', () => {
    expect(metres(-0.0001)).toBe('0.000');
    expect(signed(-0.25, 2)).toBe('−0.25');
    expect(percent(0)).toBe('0 %');
    expect(percent(0.00001)).toBe('< 0.01 %');
  });

  it.each([
    [0, 20, false, [0, 5, 10, 15, 20]], [0, 1, false, [0, 0.2, 0.4, 0.6, 0.8, 1]], [0.01, 100, true, [0.01, 0.1, 1, 10, 100]],
    [2, 6, true, [2, 3.5, 6]], [1, 1, false, []],
  ] as const)('are round along a scale from %f to %f', (low, high, logarithmic, expected) => {
    const got = ticks(low, high, logarithmic);
    expect(got).toHaveLength(expected.length);
    got.forEach((v, i) => expect(v).toBeCloseTo(expected[i], 9));
  });
});

describe('The name of a file', () => {
  it.each([['room.glb', 'room'], ['a b/c.gltf.gz', 'a_b_c'], ['Büro-2.glb', 'Büro-2'], ['.glb', 'lobe']])('%s gives %s', (title, name) => {
    expect(stem(title)).toBe(name);
  });
});
