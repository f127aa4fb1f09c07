import { describe, expect, it } from "vitest";
import type { Snapshot } from "../contract/types";
import { NO_LINK, reduce, type Link, type LinkEvent } from "./link";

const session = (revision: number): Snapshot => ({ revision, state: "idle" }) as Snapshot;
const frame = (seq: number, dropped = 0): LinkEvent => ({ type: "frame", seq, dropped, ageAtSendMs: 2, nowMs: seq });
const after = (...events: LinkEvent[]): Link => events.reduce(reduce, NO_LINK);

describe("the link", () => {
  it("opens with the session of hello and forgets the attempts", () => {
    const link = after({ type: "connecting" }, { type: "connecting" }, { type: "opened", session: session(3) });
    expect(link).toMatchObject({ phase: "open", attempt: 0, problem: null });
    expect(link.session?.revision).toBe(3);
  });

  it("keeps the last session while closed, and says why it closed", () => {
    const link = after({ type: "opened", session: session(3) }, { type: "closed", reason: "gone" });
    expect(link).toMatchObject({ phase: "closed", problem: "gone", roundTripMs: null });
    expect(link.session?.revision).toBe(3);
  });

  it("takes a lower revision too: a new rig process counts anew", () => {
    expect(
      after({ type: "opened", session: session(9) }, { type: "session", session: session(1) }).session?.revision,
    ).toBe(1);
  });

  it("adds up the drops of several connections", () => {
    const link = after(
      { type: "opened", session: session(0) },
      frame(10, 2),
      frame(11, 5),
      { type: "closed", reason: "" },
      { type: "opened", session: session(0) },
      frame(12, 1),
    );
    expect(link.dropped).toBe(6);
  });

  it("counts frames that do not advance", () => {
    expect(after(frame(10), frame(11), frame(11), frame(4), frame(5)).outOfOrder).toBe(2);
  });

  it("never changes the state it was given", () => {
    const before = Object.freeze(after(frame(1)));
    reduce(before, frame(2));
    expect(before.seq).toBe(1);
  });
});
