import { describe, expect, it } from 'vitest';
import { trustOf } from '../src/solution/trust';

const ledger = (imbalance: number) => ({ imbalance: [imbalance, -imbalance, imbalance], delivered: [1, 1, 1] });

describe('Trust', () => {
  it('is silent about what is sound, and about files that say nothing', () => {
    expect(trustOf({ stopReason: 'converged', ledger: ledger(0.02) })).toBe('');
    expect(trustOf({})).toBe('');
  });

  it('names the worst: not converging before a coarse mesh before an early stop', () => {
    expect(trustOf({ stopReason: 'not converging', ledger: ledger(0.2) })).toBe(
      'did not converge, not to be trusted (imbalance 20 %)');
    expect(trustOf({ stopReason: 'time limit', ledger: ledger(0.2) })).toMatch(/too coarse.*20 %/);
    expect(trustOf({ stopReason: 'time limit', ledger: ledger(0.02) })).toBe('not finished (time limit)');
  });
});
