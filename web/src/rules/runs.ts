// How a run ended, in words.

import type { components } from "../contract/schema";
import { inWords } from "./format";

export type RunEnd = NonNullable<components["schemas"]["RunOut"]["end"]>;

const TITLES: Record<RunEnd, string> = {
  completed: "The path was flown to its end",
  stopped: "Stopped by command",
  source_lost: "The live source was lost: the rig stopped",
  owner_silent: "Who held the lease was silent: the rig stopped",
  server_silent: "The server was silent: the rig stopped",
  estop: "E-stop",
  fault: "A fault braked the rig",
  link_lost: "The link to the drive was lost: it braked by itself",
  process_lost: "The rig process ended in the middle of it",
};
const ORDERLY: ReadonlySet<RunEnd> = new Set(["completed", "stopped"]);

export interface Ending {
  text: string;
  title: string;
  orderly: boolean;
}

/** What the list of runs says of an end; of a fault, which. */
export function ending(end: RunEnd, code: string | null): Ending {
  const words = end === "fault" && code !== null ? `fault: ${code}` : end === "estop" ? "E-stop" : end;
  return { text: inWords(words), title: TITLES[end], orderly: ORDERLY.has(end) };
}
