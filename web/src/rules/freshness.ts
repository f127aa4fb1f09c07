/** How old the data on the screen is, and whether a person may still steer by it. */
import type { Link } from "../net/link";

/** Beyond this the numbers no longer follow the rig closely; they are marked. */
export const LATE_MS = 250;
/** Beyond this no motion may be commanded from what is on the screen. */
export const STALE_MS = 1000;

export type Freshness = "fresh" | "late" | "stale";

/** Age of the newest record now [ms]: its age when sent, half a round trip, and the wait since; null before the first. */
export function dataAgeMs(link: Link, nowMs: number): number | null {
  if (link.receivedAtMs === null || link.ageAtSendMs === null) return null;
  return Math.max(0, link.ageAtSendMs + (link.roundTripMs ?? 0) / 2 + nowMs - link.receivedAtMs);
}

/** A link that is not open is stale however young its last record is. */
export function freshness(link: Link, nowMs: number): Freshness {
  const age = dataAgeMs(link, nowMs);
  if (link.phase !== "open" || age === null || !(age <= STALE_MS)) return "stale";
  return age > LATE_MS ? "late" : "fresh";
}

export interface Vitality {
  tone: "good" | "caution" | "danger" | "none";
  word: string;
}

/** How the stream does, in a word. An open link that has brought nothing yet is of a rig without a drive. */
export function vitality(link: Link, fresh: Freshness): Vitality {
  if (link.phase !== "open") return { tone: "danger", word: "Offline" };
  if (link.receivedAtMs === null) return { tone: "none", word: "No data" };
  if (fresh === "fresh") return { tone: "good", word: "Live" };
  return fresh === "late" ? { tone: "caution", word: "Late" } : { tone: "danger", word: "Stale" };
}

/** Whether what is on the screen is to look old. A rig without a drive, on an open link, has no data to be old. */
export function looksStale(link: Link, fresh: Freshness): boolean {
  if (link.session === null) return false;
  return link.phase !== "open" || (fresh === "stale" && link.session.state !== "disconnected");
}
