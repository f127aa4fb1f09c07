import { describe, expect, it } from "vitest";
import type { Plan } from "../contract/types";
import { blockingOf, outcomeOf } from "./plan";

const REPORT = { feasible: true, max_error_deg: 3.2e-14, limit_violations: [], blocking: null };

function plan(fields: object, report: object | null = REPORT): Plan {
  return {
    status: "done",
    flyable: true,
    refusal: null,
    error: null,
    progress: { phase: "solving", fraction: 0.5 },
    report,
    ...fields,
  } as unknown as Plan;
}

describe("the outcome of a plan", () => {
  it("follows its job", () => {
    expect(outcomeOf(plan({ status: "queued" }, null)).word).toBe("Queued");
    expect(outcomeOf(plan({ status: "running" }, null))).toMatchObject({ word: "Solving", detail: "solving, 50 %" });
    expect(outcomeOf(plan({ status: "failed", error: { code: "x", message: "no memory" } }, null))).toMatchObject({
      tone: "danger",
      detail: "no memory",
    });
    expect(outcomeOf(plan({ status: "cancelled" }, null)).word).toBe("Cancelled");
  });

  it("tells flyable from feasible: a feasible plan may still be refused", () => {
    expect(outcomeOf(plan({}))).toMatchObject({ tone: "good", word: "Flyable", detail: "largest error 3.2e−14 deg" });
    expect(outcomeOf(plan({ flyable: false, refusal: "no room for the lead-in" }))).toMatchObject({
      tone: "caution",
      detail: "no room for the lead-in",
    });
  });

  it("names what is in the way", () => {
    const blocking = { frame: "inner", limit: "rate", time_s: 1.25 };
    const violation = { frame: "base", limit: "acceleration", time_s: 2, value: 812.34, samples: 1 };
    const blocked = plan({ flyable: false }, { ...REPORT, feasible: false, blocking, limit_violations: [violation] });
    expect(outcomeOf(blocked)).toMatchObject({
      tone: "danger",
      word: "Not feasible",
      detail: "inner rate limit at 1.250 s",
    });
    expect(blockingOf(plan({}, { ...REPORT, limit_violations: [violation] }))).toBe(
      "base acceleration reaches 812.3 deg/s² at 2.000 s",
    );
    expect(blockingOf(plan({}))).toBeNull();
  });
});
