/** What the console knows of its connection to one rig: a pure reducer over what the stream reports. */
import type { Snapshot } from "../contract/types";

export interface Link {
  phase: "connecting" | "open" | "closed";
  /** Attempts since the connection was last open. */
  attempt: number;
  session: Snapshot | null;
  /** Sequence number of the newest record, or null before the first. */
  seq: number | null;
  /** Records the server says this client lost, all connections together. */
  dropped: number;
  /** The same counter at the start of this connection. */
  droppedBefore: number;
  /** Frames that came with a sequence number not above the last one. */
  outOfOrder: number;
  roundTripMs: number | null;
  /** Age of the newest record as the server sent it [ms]. */
  ageAtSendMs: number | null;
  /** Local time at which it arrived [ms]. */
  receivedAtMs: number | null;
  problem: string | null;
}

export type LinkEvent =
  | { type: "connecting" }
  | { type: "opened"; session: Snapshot }
  | { type: "closed"; reason: string }
  | { type: "session"; session: Snapshot }
  | { type: "frame"; seq: number; dropped: number; ageAtSendMs: number; nowMs: number }
  | { type: "pong"; roundTripMs: number }
  | { type: "problem"; message: string };

export const NO_LINK: Link = {
  phase: "connecting",
  attempt: 0,
  session: null,
  seq: null,
  dropped: 0,
  droppedBefore: 0,
  outOfOrder: 0,
  roundTripMs: null,
  ageAtSendMs: null,
  receivedAtMs: null,
  problem: null,
};

export function reduce(link: Link, event: LinkEvent): Link {
  switch (event.type) {
    case "connecting":
      return { ...link, phase: "connecting", attempt: link.attempt + 1 };
    case "opened":
      return { ...link, phase: "open", attempt: 0, session: event.session, droppedBefore: link.dropped, problem: null };
    case "closed":
      return { ...link, phase: "closed", roundTripMs: null, problem: event.reason };
    case "session":
      // Only the stream brings snapshots, in order, so the last one is the newest, also where a new rig process has
      // begun to count its revisions anew.
      return { ...link, session: event.session };
    case "frame": {
      const outOfOrder = link.seq !== null && event.seq <= link.seq ? link.outOfOrder + 1 : link.outOfOrder;
      return {
        ...link,
        seq: event.seq,
        outOfOrder,
        dropped: link.droppedBefore + event.dropped,
        ageAtSendMs: event.ageAtSendMs,
        receivedAtMs: event.nowMs,
      };
    }
    case "pong":
      return { ...link, roundTripMs: event.roundTripMs };
    case "problem":
      return { ...link, problem: event.message };
  }
}
