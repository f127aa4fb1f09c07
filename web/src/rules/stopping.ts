/** A Stop or an E-stop that was not answered, and what tells that it came through all the same. */

import type { StateName, Urgent } from "../contract/types";

export const NAMES: Record<Urgent, string> = { stop: "Stop", estop: "E-stop" };

/** States that a Stop leads out of. */
const STOPPABLE: ReadonlySet<string> = new Set<StateName>(["positioning", "running", "held", "live"]);

/** Whether a state that was heard of after the press shows that there is nothing left to press for. */
export function settled(what: Urgent, state: string): boolean {
  return what === "estop" ? state === "estopped" || state === "disconnected" : !STOPPABLE.has(state);
}

/** What is kept in sight of a press that was not answered. */
export function unconfirmedText(what: Urgent, why: string): string {
  return `${NAMES[what]} not confirmed: ${why}. If the rig moves, use the hardware E-stop.`;
}
