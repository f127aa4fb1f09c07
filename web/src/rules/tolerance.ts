/** A flight's tolerance: what a slider offers, and what it does to the flight, in words. */
import type { Plan, ToleranceEffect } from "../contract/types";

/** What the slider offers [deg], on a logarithmic scale. */
export interface ToleranceRange {
  low: number;
  high: number;
}

/** One step of the slider, of its whole length. */
export const STEP = 0.01;

const WIDEST_DEG = 90;
const NOTHING_SUGGESTED_DEG = 0.1;
const SLIDER: Pick<ToleranceRange, "low" | "high"> = { low: 0.5, high: 10 };

type Suggestion = Pick<ToleranceEffect, "suggested_tolerance_deg" | "tolerance_floor_deg">;

/** From half the floor, where it is seen not to help, to ten times what is enough. */
export function rangeOf({ suggested_tolerance_deg, tolerance_floor_deg }: Suggestion): ToleranceRange {
  const suggested = suggested_tolerance_deg ?? NOTHING_SUGGESTED_DEG;
  return {
    low: SLIDER.low * Math.min(tolerance_floor_deg ?? suggested, suggested),
    high: Math.min(SLIDER.high * suggested, WIDEST_DEG),
  };
}

/** Where a tolerance is on the slider, 0 to 1. */
export function placeOf(toleranceDeg: number, { low, high }: ToleranceRange): number {
  return Math.min(1, Math.max(0, Math.log(toleranceDeg / low) / Math.log(high / low)));
}

/** The tolerance at a place of the slider [deg], in two digits. */
export function toleranceAt(place: number, { low, high }: ToleranceRange): number {
  return Number((low * (high / low) ** place).toPrecision(2));
}

/** An angle in as many digits as tell it. */
export const degrees = (value: number): string => `${Number(value.toPrecision(2))} deg`;

const acceleration = (value: number): string => Number(value.toPrecision(3)).toLocaleString("en-US");

/** The body's peak acceleration, before and after. */
export function accelerationsOf({ recorded, flown }: Pick<ToleranceEffect, "recorded" | "flown">): string {
  return `${acceleration(recorded.acceleration_deg_s2)} → ${acceleration(flown.acceleration_deg_s2)} deg/s²`;
}

/** What to mind about a tolerance; null: nothing. */
export function cautionOf(effect: ToleranceEffect): string | null {
  const { within_tolerance, suggested_tolerance_deg, tolerance_floor_deg, deviation_deg } = effect;
  if (within_tolerance) return null;
  const floor = tolerance_floor_deg === null ? "" : ` Below ${degrees(tolerance_floor_deg)} none helps.`;
  const enough = suggested_tolerance_deg === null ? "" : ` ${degrees(suggested_tolerance_deg)} is enough.`;
  return `Too tight: the flight behind the noise is up to ${degrees(deviation_deg.max)} away.${floor}${enough}`;
}

/** The tolerance that would take away what a plan was refused for; null where that is not the recording. */
export function suggestionFor({ report, tolerance_deg }: Plan): number | null {
  const suggested = report?.suggested_tolerance_deg ?? null;
  return report?.feasible === false && suggested !== null && suggested > (tolerance_deg ?? 0) ? suggested : null;
}
