/** A rig's frames as the console lists them. */
import { FRAMES, type FrameName, type Rig, type FrameLimits } from "../contract/types";

export interface RigFrame {
  name: FrameName;
  /** Column in every array of four. */
  index: number;
  limits: FrameLimits;
}

/** The frames a rig really has, from the outside in; none while it is not known. */
export function framesOf(rig: Rig | undefined): RigFrame[] {
  if (!rig) return [];
  return FRAMES.flatMap((name, index) => {
    const limits = rig.frames[name];
    return limits ? [{ name, index, limits }] : [];
  });
}
