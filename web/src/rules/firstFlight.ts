/** The way from an empty server to a first flight: what is done of it, and what comes next. */
import type { StateName } from "../contract/types";

export interface FirstStep {
  label: string;
  help: string;
  done: boolean;
}

export interface FirstNow {
  leased: boolean;
  state: StateName | null;
  flights: number;
  /** A plan that can be flown on the rig is chosen. */
  plan: boolean;
}

const BEFORE_ARMED: ReadonlySet<StateName | null> = new Set<StateName | null>([null, "disconnected", "idle", "ready"]);

export function firstFlight({ leased, state, flights, plan }: FirstNow): FirstStep[] {
  const armed = !BEFORE_ARMED.has(state);
  return [
    {
      label: "Take control",
      help: "One window commands the rig, the others watch. Its button is above.",
      done: leased,
    },
    {
      label: "Connect",
      help: "Starts the rig's process and its drive. A built-in rig is simulated: nothing real moves.",
      done: state !== null && state !== "disconnected",
    },
    {
      label: "Drop a flight",
      help: "A CSV or a log with time and attitude; how it is read is guessed, and said.",
      done: flights > 0,
    },
    { label: "Plan", help: "Solves the rig's angles and checks them against its limits.", done: plan || armed },
    {
      label: "Load and arm",
      help: "Binds the plan to the rig and enables the drives. Nothing moves yet.",
      done: armed,
    },
    {
      label: "Start",
      help: "Moves to the start, then flies. Space holds, Esc stops.",
      done: armed && state !== "armed",
    },
  ];
}
