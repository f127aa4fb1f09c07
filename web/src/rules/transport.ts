/** Moving through recorded or planned time: play, seek, step. Times in seconds. */
import type { Range } from "./limits";

export const SPEEDS = [0.25, 0.5, 1, 2, 4] as const;

export function within(at: number, [first, last]: Range): number {
  return Math.min(last, Math.max(first, at));
}

/** Where playing has come to after `elapsedS` of the wall's time, and whether it goes on. */
export function advance(at: number, elapsedS: number, speed: number, range: Range): { at: number; playing: boolean } {
  const next = within(at + elapsedS * speed, range);
  return { at: next, playing: next < range[1] };
}

/** Where a key leads: arrows a step or, with Shift, a second; Home and End to the ends. Null for another key. */
export function seekOfKey(key: string, shift: boolean, at: number, range: Range, stepS: number): number | null {
  const by = shift ? Math.max(1, stepS) : stepS;
  if (key === "ArrowLeft") return within(at - by, range);
  if (key === "ArrowRight") return within(at + by, range);
  if (key === "Home") return range[0];
  if (key === "End") return range[1];
  return null;
}

/** Index of the time nearest to `at`; `times` ascend. -1 where there are none. */
export function nearest(times: ArrayLike<number>, at: number): number {
  let low = 0;
  let high = times.length - 1;
  while (low < high) {
    const middle = (low + high) >> 1;
    if ((times[middle] as number) < at) low = middle + 1;
    else high = middle;
  }
  if (low > 0 && at - (times[low - 1] as number) <= (times[low] as number) - at) return low - 1;
  return times.length > 0 ? low : -1;
}
