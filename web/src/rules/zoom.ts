/** Views of a stretch of time: zoomed about a moment, moved, never beyond what there is. Times in seconds. */
import type { Curve } from "../net/curves";
import type { Range } from "./limits";

/** No view is narrower: ten samples at 1 kHz. */
export const NARROWEST_S = 0.01;

/** The view within all there is, as long as it was where that fits. */
export function held([from, to]: Range, [first, last]: Range): Range {
  const length = Math.min(Math.max(to - from, Math.min(NARROWEST_S, last - first)), last - first);
  const begin = Math.min(Math.max(from, first), last - length);
  return [begin, begin + length];
}

/** The view made `factor` times as long about the moment `at`, which stays where it is on the screen. */
export function zoomed([from, to]: Range, at: number, factor: number, all: Range): Range {
  const length = Math.max(NARROWEST_S, (to - from) * factor);
  const share = to > from ? (at - from) / (to - from) : 0.5;
  const begin = at - share * length;
  return held([begin, begin + length], all);
}

/** The view moved by a share of its length. */
export function moved([from, to]: Range, share: number, all: Range): Range {
  const by = share * (to - from);
  return held([from + by, to + by], all);
}

/** What a key does to the view: + and − zoom about `at`, Page up and down move it, 0 shows all; null for another key. */
export function viewOfKey(key: string, view: Range, at: number, all: Range): Range | null {
  const about = at >= view[0] && at <= view[1] ? at : (view[0] + view[1]) / 2;
  if (key === "+" || key === "=") return zoomed(view, about, 0.5, all);
  if (key === "-") return zoomed(view, about, 2, all);
  if (key === "PageUp") return moved(view, -0.5, all);
  if (key === "PageDown") return moved(view, 0.5, all);
  return key === "0" ? all : null;
}

/** Points of a line that touches the least and the greatest value of every bucket. */
export function traced(time: Curve, curve: Curve): { time: Float64Array; values: Float64Array } {
  if (time.least === time.greatest) return { time: time.least, values: curve.least };
  const count = time.least.length;
  const points = { time: new Float64Array(2 * count), values: new Float64Array(2 * count) };
  for (let k = 0; k < count; k++) {
    points.time[2 * k] = time.least[k] as number;
    points.time[2 * k + 1] = time.greatest[k] as number;
    points.values[2 * k] = curve.least[k] as number;
    points.values[2 * k + 1] = curve.greatest[k] as number;
  }
  return points;
}

/** "1:02:03", "2:03", or "2:03.417" where the view is short. */
export function timeText(seconds: number, viewS: number): string {
  const digits = viewS >= 10 ? 0 : viewS >= 1 ? 1 : 3;
  const rounded = Number(Math.abs(seconds).toFixed(digits));
  const hours = Math.floor(rounded / 3600);
  const minutes = Math.floor((rounded % 3600) / 60);
  const rest = (rounded % 60).toFixed(digits).padStart(digits ? digits + 3 : 2, "0");
  const text = hours > 0 ? `${hours}:${String(minutes).padStart(2, "0")}:${rest}` : `${minutes}:${rest}`;
  return seconds < 0 && rounded > 0 ? `−${text}` : text;
}
