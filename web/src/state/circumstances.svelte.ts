/** What the command rules are asked about, gathered from the rig and the library. */
import { otherwise } from "../rules/choice";
import { limitsJerk } from "../rules/margins";
import type { Circumstances } from "../rules/commands";
import type { Library } from "./library.svelte";
import type { Identity } from "./identity.svelte";
import type { Operated } from "./rig.svelte";

export class Gathered {
  readonly now: Circumstances;

  constructor(operated: Operated, library: Library, identity: Identity) {
    this.now = $derived({
      role: identity.role,
      state: operated.state,
      allowed: operated.session?.allowed ?? [],
      freshness: operated.freshness,
      leased: operated.lease.held,
      plan: library.chosenPlan?.flyable === true && library.chosenPlan.rig === operated.name,
      unacknowledged: operated.unacknowledged,
      busy: operated.busy,
      otherwise: otherwise(operated.session?.plan ?? null, library.chosen),
      holdable: !limitsJerk(library.rigs.find(({ name }) => name === operated.name)),
    });
  }
}
