/** Alarms in words, and in the order they are read in. */
import type { Alarm } from "../contract/types";
import { clockTime, fixed } from "./format";

/** When it occurred last [s since 1970]. */
export function newest(alarm: Alarm): number {
  return alarm.last_time_s ?? alarm.time_s;
}

export function newestFirst(a: Alarm, b: Alarm): number {
  return newest(b) - newest(a) || b.number - a.number;
}

/** What it is of: code, frame, value and the limit it is past, and how often it came. */
export function causeOf({ first, code, frame, value, limit, unit, count, time_s }: Alarm): string {
  const what = `${first ? "first cause, " : ""}${code.replaceAll("_", " ")}${frame ? `, ${frame}` : ""}`;
  const past = typeof limit === "number" ? ` past ${fixed(limit, 3)}` : "";
  const much = typeof value === "number" ? `: ${fixed(value, 3)}${past} ${unit ?? ""}`.trimEnd() : "";
  return `${what}${much}${count > 1 ? ` (${count} times since ${clockTime(time_s)})` : ""}`;
}
