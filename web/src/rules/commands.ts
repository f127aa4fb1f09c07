/** Which command may be given now, and why not. The server decides; this only spares the operator a refusal. */
import type { CommandName, Role, StateName } from "../contract/types";
import type { Freshness } from "./freshness";
import { permitted } from "./roles";

export interface CommandLook {
  name: CommandName;
  label: string;
  /** Sets the rig in motion or lets it: refused on stale data. */
  motion: boolean;
  key?: string;
}

const motion = (name: CommandName, label: string): CommandLook => ({ name, label, motion: true });
const still = (name: CommandName, label: string, key?: string): CommandLook =>
  key ? { name, label, motion: false, key } : { name, label, motion: false };

/** In the order of their buttons. Stop and E-stop are not here: they have buttons of their own, always enabled. */
export const COMMANDS: readonly CommandLook[] = [
  still("connect", "Connect"),
  still("load", "Load"),
  motion("arm", "Arm"),
  motion("start", "Start"),
  motion("go_live", "Go live"),
  still("hold", "Hold", "Space"),
  motion("resume", "Resume"),
  motion("move", "Move, jog…"),
  motion("home", "Home"),
  still("disarm", "Disarm"),
  still("unload", "Unload"),
  still("acknowledge", "Acknowledge"),
  still("reset", "Reset"),
];

export interface Circumstances {
  /** Of who is signed in; null where nobody need be. */
  role: Role | null;
  state: StateName | null;
  allowed: readonly string[];
  freshness: Freshness;
  /** Whether this console holds the lease. */
  leased: boolean;
  /** Whether a plan that can be flown on this rig is chosen, for `load`. */
  plan: boolean;
  /** Alarms that wait to be acknowledged. */
  unacknowledged: number;
  /** A command of ours is under way. */
  busy: boolean;
  /** Why what is loaded is not to be started: it is not what is chosen; null where it is. */
  otherwise: string | null;
  /** Whether a hold on the path would keep the rig's limits: not where it limits jerk. */
  holdable: boolean;
}

export type Verdict = { enabled: true } | { enabled: false; why: string };

const no = (why: string): Verdict => ({ enabled: false, why });

/** Those without a button in the bar that move nothing. */
const QUIET: ReadonlySet<CommandName> = new Set<CommandName>(["shelve", "unshelve"]);

/** Whether `command` may be given. Stop and E-stop always may: no lease, no fresh data, no link state is asked for. */
export function verdict(command: CommandName, now: Circumstances): Verdict {
  if (command === "stop" || command === "estop") return { enabled: true };
  const role = permitted("operator", now.role);
  if (!role.enabled) return role;
  if (now.state === null) return no("No word from the rig yet");
  if (!now.allowed.includes(command)) return no(`Not allowed while ${now.state}`);
  const look = COMMANDS.find(({ name }) => name === command);
  if ((look?.motion ?? !QUIET.has(command)) && now.freshness === "stale")
    return no("Data is stale: motion is disabled");
  if (!now.leased) return no("Take control first");
  if ((command === "start" || command === "go_live") && now.otherwise !== null) return no(now.otherwise);
  if (command === "hold" && !now.holdable) return no("A rig with jerk limits is not held on its path: stop it (Esc)");
  if (command === "load" && !now.plan) return no("Choose a plan first");
  if (command === "acknowledge" && now.unacknowledged === 0) return no("No alarm waits");
  if (command === "reset" && now.unacknowledged > 0) return no("Acknowledge the alarms first");
  // A hold waits for nothing of ours.
  if (now.busy && command !== "hold") return no("A command is under way");
  return { enabled: true };
}

/** What stands in the bar: go live in the place of start where a live source is loaded, acknowledge in that of reset. */
export function shownCommands(live: boolean, unacknowledged: number): readonly CommandLook[] {
  const hidden = new Set([live ? "start" : "go_live", unacknowledged > 0 ? "reset" : "acknowledge"]);
  return COMMANDS.filter(({ name }) => !hidden.has(name));
}

/** The step a run most likely takes next, drawn as the main button; null where there is none. */
export function nextStep(state: StateName | null, live = false): CommandName | null {
  const steps: Partial<Record<StateName, CommandName>> = {
    disconnected: "connect",
    idle: "load",
    ready: "arm",
    armed: live ? "go_live" : "start",
    running: "hold",
    held: "resume",
  };
  return state === null ? null : (steps[state] ?? null);
}

/** After a trip: acknowledge while an alarm waits for it, then reset. */
export function recoveryStep(state: StateName | null, unacknowledged: number): CommandName | null {
  if (state !== "faulted" && state !== "estopped") return null;
  return unacknowledged > 0 ? "acknowledge" : "reset";
}
