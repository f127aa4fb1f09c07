import { expect, it } from "vitest";
import { FLAG } from "../adapter/telemetry";
import { liveLook } from "./live";

it("says whether a live source is followed", () => {
  expect(liveLook("armed", 0, NaN).word).toBe("loaded, not flown");
  expect(liveLook("live", 0, NaN)).toMatchObject({ tone: "caution", word: "waiting for its first sample" });
  expect(liveLook("live", FLAG.stale | 8, 0.1)).toMatchObject({ tone: "caution", word: "late, extrapolated" });
  expect(liveLook("live", 8, 0.1)).toEqual({ tone: "active", word: "followed" });
});
