/** Limits as they are drawn: the range of an axis, and how near a value is. */

import type { FrameLimits } from "../contract/types";

export type Range = readonly [low: number, high: number];

/** Extent of the finite values of `data`, or null where there is none. */
export function extent(...columns: ArrayLike<number>[]): Range | null {
  let low = Infinity;
  let high = -Infinity;
  for (const column of columns) {
    for (let i = 0; i < column.length; i++) {
      const value = column[i] as number;
      if (value < low) low = value;
      if (value > high) high = value;
    }
  }
  return low <= high && Number.isFinite(low) && Number.isFinite(high) ? [low, high] : null;
}

/** An axis that holds the data with air above and below, and spans at least `least`. */
export function dataRange(data: Range | null, least: number): Range {
  const [low, high] = data ?? [0, 0];
  const half = Math.max((high - low) * 0.6, least / 2);
  const middle = (low + high) / 2;
  return [middle - half, middle + half];
}

/** An axis that shows both limits and all of the data; without limits, the data. */
export function limitRange(limits: Range | null, data: Range | null, least: number): Range {
  if (!limits) return dataRange(data, least);
  const [low, high] = limits;
  const air = (high - low) * 0.08;
  return [Math.min(low, data?.[0] ?? low) - air, Math.max(high, data?.[1] ?? high) + air];
}

/** Position limits, or null for a frame that turns without end. */
export function positionLimits(frame: FrameLimits | undefined): Range | null {
  return frame && frame.min_deg !== null && frame.max_deg !== null ? [frame.min_deg, frame.max_deg] : null;
}

export function rateLimits(frame: FrameLimits | undefined): Range | null {
  return frame && frame.max_rate_deg_s !== null ? [-frame.max_rate_deg_s, frame.max_rate_deg_s] : null;
}

/** Share of the way to the nearer limit that `value` has used: 0 in the middle, 1 at the limit; null without limits. */
export function used(value: number, limits: Range | null): number | null {
  if (!limits || !Number.isFinite(value)) return null;
  const [low, high] = limits;
  return Math.abs(value - (low + high) / 2) / ((high - low) / 2);
}

export type Nearness = "clear" | "near" | "at";

/** How a used share is coloured. */
export function nearness(share: number | null): Nearness {
  if (share === null || share < 0.8) return "clear";
  return share < 0.95 ? "near" : "at";
}
