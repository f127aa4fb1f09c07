/** What becomes of a live source, as far as telemetry tells. */
import { FLAG, type LiveHealth } from "../contract/types";
import { fixed, integer } from "./format";

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

/** What came from the source, in a line: rate, age or time known ahead, and what was not used. */
export function liveFigures(health: LiveHealth | null): string {
  if (!health || health.accepted + health.bad === 0) return "";
  const said = [`${fixed(health.rate_hz, 0)} Hz`];
  if (health.age_ms !== null) {
    said.push(health.age_ms > 0 ? `${fixed(health.age_ms, 0)} ms late` : `${fixed(-health.age_ms, 0)} ms ahead`);
  }
  const unused = health.dropped + health.bad + health.implausible;
  if (unused > 0) said.push(`${integer(unused)} not used`);
  if (health.way_age_ms !== null && health.way_age_ms > 500)
    said.push(`planner silent ${fixed(health.way_age_ms / 1000, 1)} s`);
  return said.join(" · ");
}
