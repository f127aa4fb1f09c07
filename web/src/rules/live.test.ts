import { expect, it } from "vitest";
import { FLAG } from "../contract/types";
import { liveFigures, liveLook } from "./live";

it("says whether a live source is followed", () => {
  expect(liveLook("armed", 0, NaN).word).toBe("loaded, not flown");
  expect(liveLook("live", 0, NaN)).toMatchObject({ tone: "caution", word: "waiting for its first sample" });
  expect(liveLook("live", FLAG.stale | 8, 0.1)).toMatchObject({ tone: "caution", word: "late, extrapolated" });
  expect(liveLook("live", 8, 0.1)).toEqual({ tone: "active", word: "followed" });
});

it("tells rate, age and what was not used", () => {
  const health = {
    rate_hz: 499.6,
    age_ms: -2.4,
    accepted: 900,
    dropped: 0,
    bad: 0,
    clock_steps: 0,
    implausible: 0,
    unproven: 0,
    way_age_ms: null,
  };
  expect(liveFigures(null)).toBe("");
  expect(liveFigures({ ...health, accepted: 0 })).toBe("");
  expect(liveFigures(health)).toBe("500 Hz · 2 ms ahead");
  expect(liveFigures({ ...health, age_ms: 31, dropped: 2, bad: 1 })).toBe("500 Hz · 31 ms late · 3 not used");
  expect(liveFigures({ ...health, way_age_ms: 1200 })).toBe("500 Hz · 2 ms ahead · planner silent 1.2 s");
});
