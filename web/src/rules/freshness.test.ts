import { describe, expect, it } from "vitest";
import { NO_LINK, type Link } from "../net/link";
import { dataAgeMs, freshness, LATE_MS, looksStale, STALE_MS, vitality } from "./freshness";

const OPEN: Link = { ...NO_LINK, phase: "open", ageAtSendMs: 3, receivedAtMs: 1000, roundTripMs: 8 };

describe("the age of the data", () => {
  it("is the age when sent, half the round trip, and the wait since", () => {
    expect(dataAgeMs(OPEN, 1020)).toBe(27);
  });

  it("does without a round trip until one is measured", () => {
    expect(dataAgeMs({ ...OPEN, roundTripMs: null }, 1020)).toBe(23);
  });

  it("counts a rig process that has stopped: the server then sends old records", () => {
    expect(dataAgeMs({ ...OPEN, ageAtSendMs: 60_000 }, 1020)).toBeGreaterThan(STALE_MS);
  });

  it("is unknown before the first record", () => {
    expect(dataAgeMs(NO_LINK, 5)).toBeNull();
  });

  it("is never negative, whatever the server's clock says", () => {
    expect(dataAgeMs({ ...OPEN, ageAtSendMs: -50 }, 1000)).toBe(0);
  });
});

describe("freshness", () => {
  const at = (age: number): string => freshness({ ...OPEN, ageAtSendMs: 0, roundTripMs: 0 }, 1000 + age);

  it("goes from fresh through late to stale", () => {
    expect([0, LATE_MS, LATE_MS + 1, STALE_MS, STALE_MS + 1].map(at)).toEqual([
      "fresh",
      "fresh",
      "late",
      "late",
      "stale",
    ]);
  });

  it("is stale on a closed link, however young the last record", () => {
    expect(freshness({ ...OPEN, phase: "closed" }, 1000)).toBe("stale");
  });

  it("is stale where the age is not a number", () => {
    expect(freshness({ ...OPEN, ageAtSendMs: NaN }, 1000)).toBe("stale");
  });
});

describe("what is on the screen", () => {
  const session = (state: string): Pick<Link, "session"> => ({ session: { state } as Link["session"] });

  it("looks old on old data and on a lost link, once there is something to look old", () => {
    expect(looksStale({ ...OPEN, ...session("running") }, "late")).toBe(false);
    expect(looksStale({ ...OPEN, ...session("running") }, "stale")).toBe(true);
    expect(looksStale({ ...OPEN, ...session("disconnected"), phase: "closed" }, "stale")).toBe(true);
    expect(looksStale(NO_LINK, "stale")).toBe(false);
  });

  it("does not for a rig without a drive, which has no data", () => {
    expect(looksStale({ ...OPEN, ...session("disconnected") }, "stale")).toBe(false);
  });
});

it("has a word for how the stream does", () => {
  const open: Link = { ...NO_LINK, phase: "open", receivedAtMs: 0 };
  expect(vitality(open, "fresh")).toEqual({ tone: "good", word: "Live" });
  expect(vitality(open, "late")).toEqual({ tone: "caution", word: "Late" });
  expect(vitality(open, "stale")).toEqual({ tone: "danger", word: "Stale" });
  expect(vitality({ ...open, receivedAtMs: null }, "stale")).toEqual({ tone: "none", word: "No data" });
  expect(vitality({ ...open, phase: "closed" }, "stale")).toEqual({ tone: "danger", word: "Offline" });
});
