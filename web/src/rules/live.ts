/** What becomes of a live source, as far as telemetry tells. */
import { FLAG } from "../adapter/telemetry";

export interface LiveLook {
  tone: "active" | "caution" | "";
  word: string;
}

/** `trackingErrorDeg` is not a number before the source's first sample: there is nothing to follow. */
export function liveLook(state: string | null, flags: number, trackingErrorDeg: number): LiveLook {
  if (state !== "live") return { tone: "", word: "loaded, not flown" };
  if (Number.isNaN(trackingErrorDeg)) return { tone: "caution", word: "waiting for its first sample" };
  if ((flags & FLAG.stale) !== 0) return { tone: "caution", word: "late, extrapolated" };
  return { tone: "active", word: "followed" };
}
