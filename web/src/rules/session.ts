/** The session as the console draws it: the order of the states, and what each is called. */

import type { StateName } from "../contract/types";

export type Tone = "quiet" | "ready" | "active" | "caution" | "danger";

export interface StateLook {
  name: StateName;
  label: string;
  tone: Tone;
  meaning: string;
}

const look = (name: StateName, label: string, tone: Tone, meaning: string): StateLook => ({
  name,
  label,
  tone,
  meaning,
});

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

const LOOKS: ReadonlyMap<string, StateLook> = new Map([...PATH, ...ASIDE].map((state) => [state.name, state]));

/** A state that this console does not know, of a newer server, is shown by its name. */
export function lookOf(state: string): Omit<StateLook, "name"> {
  return LOOKS.get(state) ?? { label: state, tone: "quiet", meaning: "" };
}

/** The tone of a tag that names a state: one that asks for nothing has none. */
export function tagTone({ tone }: Pick<StateLook, "tone">): "active" | "caution" | "danger" | "" {
  return tone === "quiet" || tone === "ready" ? "" : tone;
}
