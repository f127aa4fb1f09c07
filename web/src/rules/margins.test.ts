import { describe, expect, it } from "vitest";
import type { Plan, Rig } from "../contract/types";
import { RIG } from "../testing/wire";
import { blockSentence, limitsTold, marginOf, marksOf } from "./margins";

const LIMITS = {
  min_deg: -60,
  max_deg: 60,
  max_rate_deg_s: 100,
  max_acceleration_deg_s2: null,
  max_jerk_deg_s3: null,
  home_deg: 0,
};
const FREE = { ...LIMITS, min_deg: null, max_deg: null };

function plan(position: number | null, report: object = {}): Plan {
  const margin = (value: number | null): object | null => (value === null ? null : { value, time_s: 1.5 });
  const inner = { position_deg: margin(position), rate_deg_s: margin(40), acceleration_deg_s2: null };
  return {
    method: "exact",
    margins: { inner },
    report: { blocking: null, limit_violations: [], ...report },
  } as unknown as Plan;
}

describe("a margin", () => {
  it("is coloured by its share of the limit", () => {
    expect(marginOf(plan(20), "inner", "position", LIMITS)).toMatchObject({ tone: "", text: "20.0", timeS: 1.5 });
    expect(marginOf(plan(2.9), "inner", "position", LIMITS)).toMatchObject({ tone: "caution", text: "2.90" });
    expect(marginOf(plan(-0.5), "inner", "position", LIMITS)).toMatchObject({ tone: "danger", text: "0.50 beyond" });
    expect(marginOf(plan(0.0006), "inner", "position", LIMITS)?.text).toBe("6.0e−4");
  });

  it("within the tolerance is at the limit, not beyond", () => {
    expect(marginOf(plan(-4e-6), "inner", "position", LIMITS)).toMatchObject({ tone: "caution", text: "at the limit" });
  });

  it("is none where there is no limit", () => {
    expect(marginOf(plan(null), "inner", "position", FREE)).toBeNull();
    expect(marginOf(plan(1), "inner", "acceleration", LIMITS)).toBeNull();
    expect(marginOf(plan(1), "base", "rate", LIMITS)).toBeNull();
  });
});

describe("what closes the way, as a sentence", () => {
  it("names frame, limit and time", () => {
    const blocked = plan(0, { blocking: { frame: "inner", limit: "position", time_s: 0.28 } });
    expect(blockSentence(blocked, LIMITS)).toBe(
      "At 0.280 s the inner frame meets its position limit of ±60 deg, and exact finds no way past it.",
    );
    const skew = { ...LIMITS, min_deg: -10 };
    expect(blockSentence(blocked, skew)).toContain("limit of −10 … 60 deg");
    expect(blockSentence(plan(1), LIMITS)).toBeNull();
  });

  it("is the planner's own where it has one, and both moments are marked", () => {
    const then = { frame: "outer", limit: "rate", time_s: 2.61, value: -310.04, bound: -250 };
    const what_happens = "at 2.450 s the inner frame reaches its stop at 60 deg; from there the outer would need more";
    const blocking = { frame: "inner", limit: "position", time_s: 2.45 };
    const blocked = plan(0, { blocking, verdict: { what_happens, then } });
    expect(blockSentence(blocked, LIMITS)).toBe(`A${what_happens.slice(1)}.`);
    expect(marksOf(blocked)).toEqual([
      { frame: "inner", limit: "position", timeS: 2.45, label: "position limit" },
      { frame: "outer", limit: "rate", timeS: 2.61, label: "needs 310.0 deg/s" },
    ]);
    expect(marksOf(plan(1))).toEqual([]);
  });

  it("tells how far a violation goes", () => {
    const violation = { frame: "inner", limit: "rate", time_s: 2, value: 812.34, samples: 1 };
    expect(blockSentence(plan(0, { limit_violations: [violation] }), LIMITS)).toBe(
      "At 2.000 s the inner frame reaches 812.3 deg/s, beyond its rate limit of ±100 deg/s.",
    );
  });
});

it("tells jerk of a rig that limits it, and of no other", () => {
  const { base, ...others } = RIG.frames;
  const rig: Rig = { ...RIG, frames: { ...others, base: base && { ...base, max_jerk_deg_s3: 5000 } } };
  expect(limitsTold(RIG)).not.toContain("jerk");
  expect(limitsTold(rig)).toContain("jerk");
});
