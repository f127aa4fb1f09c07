/** What the command rules are asked about, gathered from the rig and the library. */
import type { Circumstances } from "../rules/commands";
import { library } from "./library.svelte";
import { operated } from "./rig.svelte";

class Gathered {
  readonly now: Circumstances = $derived({
    state: operated.state,
    allowed: operated.session?.allowed ?? [],
    freshness: operated.freshness,
    leased: operated.leased,
    plan: library.chosenPlan?.flyable === true && library.chosenPlan.rig === operated.name,
    unacknowledged: operated.unacknowledged,
    busy: operated.busy,
  });
}

export const circumstances = new Gathered();
