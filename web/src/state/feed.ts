/** Where telemetry comes from: a rig as it lives, or a run that is replayed. Plots and figures draw either. */
import type { History } from "../net/history";
import type { Sample } from "../net/telemetry";
import type { TimeAxis } from "../rules/axis";

export interface Feed {
  readonly history: History;
  readonly latest: Sample | null;
  /** Grows with every frame: what plots wait for. */
  readonly frames: number;
  readonly axis: TimeAxis;
  /** What it last brought is not what is now: it is to look old. */
  readonly stale: boolean;
}
