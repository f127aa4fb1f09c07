/** What is loaded beside what is chosen: Start flies what is shown, or it is off. */
import type { CommandName, Plan, StateName } from "../contract/types";
import { verdict, type Circumstances, type Verdict } from "./commands";
import { kindOf } from "./remedies";

/** What the rig has: a plan by its id, a live source, or nothing. */
export type Loaded = { plan_id: string; name: string; live: boolean } | null;

export interface Chosen {
  /** A live source and not a plan. */
  live: boolean;
  flight: string | null;
  plan: string | null;
}

/** A plan by its flight and by how it was made: two plans of one flight have one name. */
export function planName(plan: Pick<Plan, "trajectory_name" | "method" | "remedy">): string {
  return `${plan.trajectory_name} (${plan.remedy ? kindOf(plan.remedy.kind).toLowerCase() : plan.method})`;
}

export const loadedName = (loaded: NonNullable<Loaded>): string => (loaded.live ? "a live source" : loaded.name);

/** Whether Start would fly something else than what is chosen. Where nothing is loaded or chosen nothing differs. */
export function differs(loaded: Loaded, chosen: Chosen): boolean {
  if (loaded === null) return false;
  if (loaded.live !== chosen.live) return chosen.live || chosen.flight !== null;
  return !loaded.live && chosen.flight !== null && chosen.plan !== loaded.plan_id;
}

/** Why what is loaded may not be started, in words; null where it is what is chosen. */
export function otherwise(loaded: Loaded, chosen: Chosen): string | null {
  if (loaded === null || !differs(loaded, chosen)) return null;
  return `Loaded is ${loadedName(loaded)}, chosen is something else: load what is chosen, or choose what is loaded`;
}

const STEPS: Partial<Record<StateName, readonly CommandName[]>> = {
  idle: ["load", "arm"],
  ready: ["unload", "load", "arm"],
  armed: ["disarm", "unload", "load", "arm"],
};

/** The commands that lead from a state to the chosen plan, loaded and armed; none where a rig moves or is tripped. */
export function stepsToArmed(state: StateName | null, same: boolean): readonly CommandName[] {
  if (same) return state === "ready" ? ["arm"] : [];
  return state === null ? [] : (STEPS[state] ?? []);
}

/** Whether these may be given now. */
export function stepsVerdict(steps: readonly CommandName[], now: Circumstances): Verdict {
  const [first] = steps;
  if (first === undefined) return { enabled: false, why: `Not while ${now.state ?? "nothing is heard of the rig"}` };
  const begun = verdict(first, now);
  if (!begun.enabled) return begun;
  if (now.freshness === "stale") return { enabled: false, why: "Data is stale: motion is disabled" };
  if (!now.plan) return { enabled: false, why: "Choose a plan that can be flown on this rig" };
  return { enabled: true };
}
