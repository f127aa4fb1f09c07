/** What a plan's report comes to, in words. */
import type { Plan } from "../contract/types";
import { fixed, small } from "./format";
import { UNITS } from "./margins";

export interface Outcome {
  tone: "good" | "caution" | "danger" | "active" | "";
  word: string;
  /** One line: why, or how well. */
  detail: string;
}

/** What stopped a flight, or how exact it is. */
export function outcomeOf(plan: Plan): Outcome {
  const { status, report } = plan;
  if (status === "queued") return { tone: "active", word: "Queued", detail: "Waiting for the planner" };
  if (status === "running") {
    return {
      tone: "active",
      word: "Solving",
      detail: `${plan.progress.phase}, ${fixed(100 * plan.progress.fraction, 0)} %`,
    };
  }
  if (status === "failed") return { tone: "danger", word: "Failed", detail: plan.error?.message ?? "No reason given" };
  if (status === "cancelled") return { tone: "", word: "Cancelled", detail: "" };
  if (status === "interrupted")
    return { tone: "", word: "Interrupted", detail: "The server stopped while it was solved" };
  if (!report) return { tone: "danger", word: "No report", detail: plan.refusal ?? "" };
  const error = `largest error ${small(report.max_error_deg)} deg`;
  if (plan.flyable) return { tone: "good", word: "Flyable", detail: error };
  if (report.feasible) return { tone: "caution", word: "Not flyable", detail: plan.refusal ?? error };
  return { tone: "danger", word: "Not feasible", detail: blockingOf(plan) ?? plan.refusal ?? error };
}

/** The first thing in the way of a plan: where, when, which limit. */
export function blockingOf(plan: Plan): string | null {
  const { report } = plan;
  if (!report) return null;
  const violation = report.limit_violations[0];
  if (report.blocking) {
    const { frame, limit, time_s } = report.blocking;
    return `${frame} ${limit} limit at ${fixed(time_s, 3)} s`;
  }
  if (violation) {
    const { frame, limit, time_s, value } = violation;
    return `${frame} ${limit} reaches ${fixed(value, 1)} ${UNITS[limit]} at ${fixed(time_s, 3)} s`;
  }
  return null;
}
