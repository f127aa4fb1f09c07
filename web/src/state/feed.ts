/** Where telemetry comes from: a rig as it lives, or a run that is replayed. Plots and figures draw either. */
import type { History } from "../adapter/history";
import type { Sample } from "../adapter/telemetry";

export interface Feed {
  readonly history: History;
  readonly latest: Sample | null;
  /** Grows with every frame: what plots wait for. */
  readonly frames: number;
}
