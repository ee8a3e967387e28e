import { afterEach, beforeEach, describe, expect, it, vi } from 'vitest';
import { Pace } from '../src/stage/pace';

beforeEach(() => void vi.useFakeTimers());
afterEach(() => void vi.useRealTimers());

describe('Pictures', () => {
  it('are fine where frames come in time, and nothing is drawn a second time', () => {
    const drawFinely = vi.fn(), pace = new Pace(drawFinely);
    for (let i = 0; i < 10; ++i) {
      expect(pace.isCoarse(16)).toBe(false);
      pace.drawn(true);
    }
    vi.advanceTimersByTime(10000);
    expect(drawFinely).not.toHaveBeenCalled();
  });

  it('are coarse from the first late frame until they come so soon that fine ones would be in time', () => {
    const pace = new Pace(() => {});
    expect(pace.isCoarse(150)).toBe(true);
    expect(pace.isCoarse(60)).toBe(true);
    expect(pace.isCoarse()).toBe(true);
    expect(pace.isCoarse(10)).toBe(false);
    expect(pace.isCoarse(60)).toBe(false);
  });

  it('are finished once they stand, and not while they move', () => {
    const finish = vi.fn(), pace = new Pace(finish);
    for (let i = 0; i < 5; ++i) {
      pace.drawn(false);
      vi.advanceTimersByTime(150);
    }
    expect(finish).not.toHaveBeenCalled();
    vi.advanceTimersByTime(100);
    expect(finish).toHaveBeenCalledTimes(1);
  });

  it('are not finished any more once the page is left', () => {
    const finish = vi.fn(), pace = new Pace(finish);
    pace.drawn(false);
    pace.stop();
    vi.advanceTimersByTime(10000);
    expect(finish).not.toHaveBeenCalled();
  });
});
