import { describe, expect, it } from "vitest";
import type { FrameLimits } from "../contract/types";
import { dataRange, extent, limitRange, nearness, positionLimits, rateLimits, used } from "./limits";

const FRAME: FrameLimits = {
  min_deg: -60,
  max_deg: 60,
  max_rate_deg_s: 600,
  max_acceleration_deg_s2: null,
  max_jerk_deg_s3: null,
  home_deg: 0,
};

describe("axes", () => {
  it("extent passes over what is not a number", () => {
    expect(extent([NaN, 3, -1], Float64Array.of(7, NaN))).toEqual([-1, 7]);
    expect(extent([NaN])).toBeNull();
    expect(extent([])).toBeNull();
  });

  it("an axis of data has air and a least span", () => {
    expect(dataRange([0, 100], 2)).toEqual([-10, 110]);
    expect(dataRange([5, 5], 2)).toEqual([4, 6]);
    expect(dataRange(null, 2)).toEqual([-1, 1]);
  });

  it("an axis of limits shows both limits, and what is past them", () => {
    const [low, high] = limitRange([-60, 60], [-5, 5], 2);
    expect(low).toBeLessThan(-60);
    expect(high).toBeGreaterThan(60);
    expect(limitRange([-60, 60], [-5, 90], 2)[1]).toBeGreaterThan(90);
    expect(limitRange(null, [0, 100], 2)).toEqual([-10, 110]);
  });
});

describe("limits", () => {
  it("come from the frame, none where it turns without end", () => {
    expect(positionLimits(FRAME)).toEqual([-60, 60]);
    expect(positionLimits({ ...FRAME, min_deg: null, max_deg: null })).toBeNull();
    expect(rateLimits(FRAME)).toEqual([-600, 600]);
    expect(rateLimits(undefined)).toBeNull();
  });

  it("are used by a share, from the middle of the range", () => {
    expect(used(0, [-60, 60])).toBe(0);
    expect(used(-54, [-60, 60])).toBeCloseTo(0.9);
    expect(used(30, [0, 40])).toBe(0.5);
    expect(used(66, [-60, 60])).toBeCloseTo(1.1);
    expect(used(5, null)).toBeNull();
    expect(used(NaN, [-1, 1])).toBeNull();
  });

  it("are coloured by that share", () => {
    expect([null, 0.79, 0.8, 0.95, 1.2].map(nearness)).toEqual(["clear", "clear", "near", "at", "at"]);
  });
});
