/** How near a plan comes to the limits, and what closes its way. */
import type { FrameName, LimitName, Plan, PlanMargin, FrameLimits, Rig } from "../contract/types";
import { fixed, scientific } from "./format";
import { positionLimits } from "./limits";
import { framesOf } from "./rig";

export const LIMITS: readonly LimitName[] = ["position", "rate", "acceleration", "jerk"];
export const UNITS: Record<LimitName, string> = {
  position: "deg",
  rate: "deg/s",
  acceleration: "deg/s²",
  jerk: "deg/s³",
};
/** What the wire calls each of them, of margins and of peaks. */
export const KEYS = {
  position: "position_deg",
  rate: "rate_deg_s",
  acceleration: "acceleration_deg_s2",
  jerk: "jerk_deg_s3",
} as const;

/** Differences of sampled angles reach a limit to this share of it and are still inside [of the limit]. */
const TOLERANCE = 1e-6;

export interface Margin {
  value: number;
  timeS: number;
  /** Beyond the limit, next to it (within a twentieth), or with room. */
  tone: "danger" | "caution" | "";
  text: string;
}

/** Whether a frame of it has a jerk limit; few rigs do. */
export function limitsJerk(rig: Rig | undefined): boolean {
  return framesOf(rig).some(({ limits }) => limits.max_jerk_deg_s3 !== null);
}

/** The limits that are told of a rig: jerk only where a frame limits it. */
export function limitsTold(rig: Rig | undefined): readonly LimitName[] {
  return limitsJerk(rig) ? LIMITS : LIMITS.filter((limit) => limit !== "jerk");
}

/** What a limit is counted in: half of a range of positions, the limit itself otherwise; null for none. */
export function sizeOf(limit: LimitName, limits: FrameLimits): number | null {
  if (limit === "rate") return limits.max_rate_deg_s;
  if (limit === "acceleration") return limits.max_acceleration_deg_s2;
  if (limit === "jerk") return limits.max_jerk_deg_s3;
  const range = positionLimits(limits);
  return range === null ? null : (range[1] - range[0]) / 2;
}

/** The smallest distance of a frame to one of its limits; null where it has none. */
export function marginOf(plan: Plan, frame: FrameName, limit: LimitName, limits: FrameLimits): Margin | null {
  const found: PlanMargin | null | undefined = plan.margins?.[frame]?.[KEYS[limit]];
  const size = sizeOf(limit, limits);
  if (!found || size === null) return null;
  const share = found.value / size;
  const tone = share < -TOLERANCE ? "danger" : share < 0.05 ? "caution" : "";
  return { value: found.value, timeS: found.time_s, tone, text: distance(found.value, Math.abs(share) <= TOLERANCE) };
}

/** A distance to a limit in words; what is within the tolerance is at the limit. */
function distance(value: number, at: boolean): string {
  if (at) return "at the limit";
  const size = Math.abs(value);
  const text = size < 0.01 ? scientific(size) : fixed(size, size < 10 ? 2 : size < 100 ? 1 : 0);
  return value < 0 ? `${text} beyond` : text;
}

export interface Blocking {
  frame: FrameName;
  limit: LimitName;
  timeS: number;
}

/** What stops a plan: the block a solver found, else the first violation that the check did. */
export function blockOf(plan: Plan): Blocking | null {
  const found = plan.report?.blocking ?? plan.report?.limit_violations[0] ?? null;
  return found && { frame: found.frame, limit: found.limit, timeS: found.time_s };
}

export interface LimitMark extends Blocking {
  label: string;
}

/** What is drawn into the plots: what blocks, and what the attitude would need from there of a frame. */
export function marksOf(plan: Plan): LimitMark[] {
  const block = blockOf(plan);
  if (!block) return [];
  const marks = [{ ...block, label: `${block.limit} limit` }];
  const then = plan.report?.verdict?.then;
  if (then) {
    const label = `needs ${fixed(Math.abs(then.value), 1)} ${UNITS[then.limit]}`;
    marks.push({ frame: then.frame, limit: then.limit, timeS: then.time_s, label });
  }
  return marks;
}

/** The block as a sentence: what happens first and what then, as the planner tells it, or the limit it is at. */
export function blockSentence(plan: Plan, limits: FrameLimits | undefined): string | null {
  const block = blockOf(plan);
  if (!block) return null;
  const told = plan.report?.verdict?.what_happens;
  if (told) return `${told[0]?.toUpperCase()}${told.slice(1)}.`;
  const { frame, limit, timeS } = block;
  const where = `At ${fixed(timeS, 3)} s the ${frame} frame`;
  const violation = plan.report?.blocking ? undefined : plan.report?.limit_violations[0];
  const bound = limits ? boundOf(limit, limits) : null;
  const of = bound ? ` of ${bound}` : "";
  if (!violation) return `${where} meets its ${limit} limit${of}, and ${plan.method} finds no way past it.`;
  return `${where} reaches ${fixed(violation.value, 1)} ${UNITS[limit]}, beyond its ${limit} limit${of}.`;
}

function boundOf(limit: LimitName, limits: FrameLimits): string | null {
  const size = sizeOf(limit, limits);
  if (size === null) return null;
  const range = limit === "position" ? positionLimits(limits) : null;
  if (range && range[0] !== -range[1]) return `${fixed(range[0], 0)} … ${fixed(range[1], 0)} ${UNITS[limit]}`;
  return `±${fixed(size, 0)} ${UNITS[limit]}`;
}
