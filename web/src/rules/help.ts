/** A sentence of help for what a person has to choose among. States have theirs in `session.ts`, roles in `roles.ts`. */
import type { Convention } from "../contract/types";

/** What each method is, as the guide says it (docs/guide/solver.md). */
const METHODS: Readonly<Record<string, string>> = {
  plan: "Solves the whole flight at once, inside the limits. The one to begin with.",
  preview: "Solves sample by sample, along a way that is planned over the attitude ahead; keeps the limits.",
  exact: "Solves each sample exactly, in closed form; keeps the limits, and sees nothing of what comes.",
  alm: "The augmented multiplier method (Zhao 2025), sample by sample; keeps the limits.",
  clamped: "Weighted least norm, with a frame locked where it is at its limit (Huang 2014); keeps the limits.",
  dwln: "Damped weighted least norm, solved again exactly (Lin 2022); may pass the limits.",
  lagrange: "The equality-constrained step without feedback (Xu 2016), the papers' baseline; may pass the limits.",
  weighted: "Weighted least squares with a base weight that adapts (Carter 2010); may pass the limits.",
  gradient_projection: "Keeps off limits and singularity in the null space (Wang 2010); may pass the limits.",
  fixed_joint: "Keeps off limits by a held frame, then solves exactly (Zu 2005); may pass the limits.",
  follow_up: "Turns the base aside as the outer frame nears 90 deg (Zhao Junhu 2017); may pass the limits.",
  three_axis: "The Euler angles themselves: what a rig without the fourth axis has to do; may pass the limits.",
};

/** Nothing for a method that this console does not know, of a newer server. */
export const methodHelp = (name: string): string => METHODS[name] ?? "";

export const CONVENTIONS: Readonly<Record<Convention | "", string>> = {
  "": "The convention is guessed from the columns, and said after reading.",
  nue: "North, up, east: yaw, pitch and roll in the rig's own axes.",
  ned: "North, east, down: heading, pitch and bank, as aircraft and autopilots write them.",
  enu: "East, north, up: yaw, pitch and roll, as ROS writes them.",
};
