/** The session as the console draws it: the order of the states, and what each is called. */

export type Tone = "quiet" | "ready" | "active" | "caution" | "danger";

export interface StateLook {
  name: string;
  label: string;
  tone: Tone;
  meaning: string;
}

const look = (name: string, label: string, tone: Tone, meaning: string): StateLook => ({ name, label, tone, meaning });

/** The way of a run, from left to right. */
export const PATH: readonly StateLook[] = [
  look("disconnected", "Disconnected", "quiet", "No link to the drive"),
  look("idle", "Idle", "quiet", "Linked, no flight loaded"),
  look("ready", "Ready", "ready", "A flight is loaded"),
  look("armed", "Armed", "caution", "Drives hold position and obey commands"),
  look("positioning", "Positioning", "active", "Moving to the start"),
  look("running", "Running", "active", "Flying the trajectory"),
  look("held", "Held", "caution", "At rest on the path"),
  look("stopping", "Stopping", "caution", "Braking inside the limits"),
];

/** States beside the way. */
export const ASIDE: readonly StateLook[] = [
  look("live", "Live", "active", "Following a live source"),
  look("faulted", "Faulted", "danger", "A guard tripped; acknowledge, then reset"),
  look("estopped", "E-stopped", "danger", "Emergency stop; acknowledge, then reset"),
];

const LOOKS = new Map([...PATH, ...ASIDE].map((state) => [state.name, state]));

export function lookOf(state: string): StateLook {
  return LOOKS.get(state) ?? look(state, state, "quiet", "");
}
