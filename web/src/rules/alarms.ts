/** Alarms in words, and in the order they are read in. */
import type { Alarm, AlarmQuery, Severity } from "../contract/types";
import { clockTime, fixed, inWords } from "./format";

/** When it occurred last [s since 1970]. */
export function newest(alarm: Alarm): number {
  return alarm.last_time_s ?? alarm.time_s;
}

export function newestFirst(a: Alarm, b: Alarm): number {
  return newest(b) - newest(a) || b.number - a.number;
}

/** What it is of: code, frame, value and the limit it is past, and how often it came. */
export function causeOf({ first, code, frame, value, limit, unit, count, time_s }: Alarm): string {
  const what = `${first ? "first cause, " : ""}${inWords(code)}${frame ? `, ${frame}` : ""}`;
  const past = typeof limit === "number" ? ` past ${fixed(limit, 3)}` : "";
  const much = typeof value === "number" ? `: ${fixed(value, 3)}${past} ${unit ?? ""}`.trimEnd() : "";
  return `${what}${much}${count > 1 ? ` (${count} times since ${clockTime(time_s)})` : ""}`;
}

/** What is shown of the history. */
export interface AlarmChoice {
  rig: string;
  severity: Severity | "";
  code: string;
  /** Local times as a field has them, "2026-11-29T10:00"; empty: without end. */
  from: string;
  to: string;
  which: "all" | "standing" | "past";
}

export const EVERY_ALARM: AlarmChoice = { rig: "", severity: "", code: "", from: "", to: "", which: "all" };

/** What the server is asked for. */
export function alarmQuery({ rig, severity, code, from, to, which }: AlarmChoice): AlarmQuery {
  return {
    rig: rig || null,
    severity: severity || null,
    code: code.trim().replaceAll(" ", "_") || null,
    from: instant(from),
    to: instant(to),
    standing: which === "all" ? null : which === "standing",
  };
}

const instant = (local: string): string | null => (local === "" ? null : new Date(local).toISOString());

/** How long a shelf lasts yet: "2 h 5 min", "40 s"; both seconds since 1970. */
export function timeLeft(untilS: number, nowS: number): string {
  const left = Math.max(0, Math.ceil(untilS - nowS));
  if (left < 60) return `${left} s`;
  const minutes = Math.floor(left / 60);
  return minutes < 60 ? `${minutes} min` : `${Math.floor(minutes / 60)} h ${minutes % 60} min`;
}
