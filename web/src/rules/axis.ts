/** The time axis of a plot that runs: seconds before now for a rig, time of the run for a record. */
import { duration } from "./format";

export type TimeAxis =
  /** `ageS`: whole seconds since the newest record; 0 while data is fresh. */
  | { kind: "age"; ageS: number }
  /** `zeroS`: time of the records at the start of the run [s]. */
  | { kind: "run"; zeroS: number };

const EVERY_S = 5;

/** Times of the ticks [s], for records whose newest is at `last` and a window of `windowS`. */
export function ticksOf(axis: TimeAxis, last: number, windowS: number): number[] {
  const start = last - windowS;
  if (axis.kind === "age") {
    // Whole seconds before the newest, so that the labels stand still while the curve moves.
    return Array.from({ length: Math.floor(windowS / EVERY_S) + 1 }, (_, i) => start + EVERY_S * i);
  }
  const ticks: number[] = [];
  for (let at = Math.max(0, Math.ceil((start - axis.zeroS) / EVERY_S)); axis.zeroS + EVERY_S * at <= last; at++) {
    ticks.push(axis.zeroS + EVERY_S * at);
  }
  return ticks;
}

/** "now", "−5 s", "−3 min"; of a run "0:15". */
export function tickText(axis: TimeAxis, at: number, last: number): string {
  if (axis.kind === "run") {
    const seconds = Math.round(at - axis.zeroS);
    return `${Math.floor(seconds / 60)}:${String(seconds % 60).padStart(2, "0")}`;
  }
  const before = Math.round(last - at + axis.ageS);
  if (before === 0) return "now";
  return before < 120 ? `−${before} s` : `−${duration(1000 * before)}`;
}
