/** What may be changed to make a flight fit, and what came of it. */
import type { Plan, RemedyKind } from "../contract/types";
import type { Outcome } from "./plan";

export interface RemedyLook {
  kind: RemedyKind;
  label: string;
  hint: string;
}

export const REMEDIES: readonly RemedyLook[] = [
  {
    kind: "tolerance",
    label: "Allow a tolerance",
    hint: "The least by which the attitude is missed inside every limit; noise of the recording is taken away first",
  },
  { kind: "slow_down", label: "Fly it slower", hint: "The least factor on its time" },
  { kind: "heading_offset", label: "Turn the heading", hint: "The whole flight, by one angle about the vertical" },
  { kind: "mounting_offset", label: "Turn the mounting", hint: "The payload in the inner frame, by one angle" },
  { kind: "relax", label: "Raise one limit", hint: "The least raise of a single limit of the rig" },
];

/** A kind in words. */
export function kindOf(kind: RemedyKind): string {
  return REMEDIES.find((each) => each.kind === kind)?.label ?? kind;
}

/** Whether there is something to remedy: solved, and not within the limits. A remedy that fails is remedied at its source. */
export function remediable(plan: Plan): boolean {
  return plan.status === "done" && plan.report?.feasible === false && plan.remedy === null;
}

/** The searches that were begun for a plan, newest first as the server lists them. */
export function remediesOf(plans: readonly Plan[], of: string): Plan[] {
  return plans.filter(({ remedy }) => remedy?.of === of);
}

/** What a search came to. */
export function foundOf(plan: Plan): Outcome {
  const { status, remedy } = plan;
  if (status === "queued") return { tone: "active", word: "Queued", detail: "" };
  if (status === "running") return { tone: "active", word: "Searching", detail: "" };
  if (status === "failed") return { tone: "danger", word: "None found", detail: plan.error?.message ?? "" };
  if (status !== "done") return { tone: "", word: status === "cancelled" ? "Cancelled" : "Interrupted", detail: "" };
  const detail = remedy?.change?.statement ?? "";
  if (remedy?.sufficient === false) return { tone: "danger", word: "Not enough", detail };
  if (!plan.flyable) return { tone: "caution", word: "Fits, not flyable yet", detail };
  return { tone: "good", word: "Fits", detail };
}
