import { afterEach, beforeEach, describe, expect, it, vi } from 'vitest';
import { Pace } from '../src/stage/pace';

beforeEach(() => void vi.useFakeTimers());
afterEach(() => void vi.useRealTimers());

describe('Pictures', () => {
  it('are fine where frames come in time, and nothing is drawn a second time', () => {
    const drawFinely = vi.fn(), pace = new Pace(drawFinely);
    for (let i = 0; i < 10; ++i) expect(pace.isCoarse(16)).toBe(false);
    vi.advanceTimersByTime(10000);
    expect(drawFinely).not.toHaveBeenCalled();
  });

  it('are coarse from the first late frame until they come so soon that fine ones would be in time', () => {
    const pace = new Pace(() => {});
    expect(pace.isCoarse(150)).toBe(true);
    expect(pace.isCoarse(60)).toBe(true);
    expect(pace.isCoarse(10)).toBe(false);
    expect(pace.isCoarse(60)).toBe(false);
  });

  it('become fine once they stand, and not while they move', () => {
    const drawFinely = vi.fn(), pace = new Pace(drawFinely);
    for (let i = 0; i < 5; ++i) {
      pace.isCoarse(150);
      vi.advanceTimersByTime(150);
    }
    expect(drawFinely).not.toHaveBeenCalled();
    vi.advanceTimersByTime(100);
    expect(drawFinely).toHaveBeenCalledTimes(1);
  });
});
