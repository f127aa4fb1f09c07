import { describe, expect, it } from "vitest";
import type { MethodFigures } from "../contract/types";
import {
  adviceOf,
  best,
  COLUMNS,
  exactText,
  fit,
  ranked,
  sentencesOf,
  standingOf,
  summaryOf,
  type Column,
} from "./compare";

const peaks = (rate: number): object => ({
  base: null,
  outer: { position_deg: 1, rate_deg_s: rate, acceleration_deg_s2: 9 },
});

function method(name: string, fields: object = {}): MethodFigures {
  const figures = {
    refusal: null,
    feasible: true,
    exact_share: 1,
    max_error_deg: 1e-13,
    limit_violation_samples: 0,
    peak: peaks(10),
  };
  return {
    label: name,
    method: name,
    source: "",
    claims_limits: true,
    ...figures,
    ...fields,
  } as unknown as MethodFigures;
}

function column(key: string): Column {
  const found = COLUMNS.find((each) => each.key === key);
  if (!found) throw new Error(key);
  return found;
}

const bestOf = (key: string, methods: MethodFigures[]): string[] => [...best(column(key), methods, 1e-9)];

describe("what a method comes to", () => {
  it("names the limit that most samples are beyond", () => {
    const counts = {
      base: { position: 0, rate: 169, acceleration: 461 },
      inner: { position: 19671, rate: 0, acceleration: 0 },
    };
    const over = method("three_axis", { feasible: false, limit_violation_counts: counts });
    expect(standingOf(over)).toEqual({
      tone: "danger",
      word: "Not feasible",
      detail: "inner position, 19,671 samples",
    });
  });

  it("tells inside the limits from exact", () => {
    const failures = [{ reason: "linearised step", samples: 1, first_s: 0, max_error_deg: 1 }];
    expect(standingOf(method("lagrange", { exact_share: 0.2, failures }))).toMatchObject({
      tone: "caution",
      detail: "linearised step, 1 sample",
    });
    expect(standingOf(method("exact")).tone).toBe("good");
    expect(standingOf(method("x", { refusal: "needs four axes", feasible: null }))).toMatchObject({
      tone: "",
      detail: "needs four axes",
    });
  });

  it("never rounds up to all of it, nor down to none", () => {
    const text = (exact_percent: number | null, exact_samples: number | null): string =>
      exactText(method("a", { exact_percent, exact_samples }));
    expect([text(100, 9), text(99.99, 8), text(0.3, 2), text(0, 1), text(0, 0), text(null, null)]).toEqual([
      "100 %",
      "99.99 %",
      "0.30 %",
      "< 0.01 %",
      "0 %",
      "–",
    ]);
  });

  it("counts no iterations of a method that stopped before its first sample", () => {
    const { text, more, value } = column("iterations");
    const at = (median: number, max: number): unknown[] =>
      [value, text, more].map((of) => of?.(method("a", { iterations: { median, max } })));
    expect(at(0, 0)).toEqual([null, "–", null]);
    expect(at(2, 30)).toEqual([2, "2", "most 30"]);
  });

  it("adds up the way of all frames", () => {
    const { value } = column("way");
    expect(value(method("a", { total_variation_deg: { base: 1.5, outer: 2 } }))).toBe(3.5);
    expect(value(method("a", { total_variation_deg: null }))).toBeNull();
  });
});

describe("what keeps a method from it", () => {
  it("is a sentence of each that it keeps; how sure only of what is refused", () => {
    const why = "at 2.450 s the inner frame reaches its stop at 60 deg";
    const methods = [
      method("plan", { feasible: false, why, how_sure: "Evidence, not a proof." }),
      method("exact", { why: null }),
      method("lagrange", { why: "3 of 9 samples miss the attitude", how_sure: null }),
    ];
    expect(sentencesOf(methods)).toEqual([
      {
        label: "plan",
        text: "At 2.450 s the inner frame reaches its stop at 60 deg.",
        howSure: "Evidence, not a proof.",
      },
      { label: "lagrange", text: "3 of 9 samples miss the attitude.", howSure: null },
    ]);
  });

  it("is the recording where a tolerance is suggested, and one is not yet given", () => {
    const report = (tolerance_deg: number | null, suggested_tolerance_deg: number | null): string | null =>
      adviceOf({ tolerance_deg, suggested_tolerance_deg } as never);
    expect(report(null, 0.05)).toBe("A tolerance of 0.05 deg takes away what the recording added.");
    expect(report(0.05, 0.05)).toBeNull();
    expect(report(null, null)).toBeNull();
  });
});

describe("the best value", () => {
  it("is not marked where all are the same", () => {
    expect(bestOf("exact", [method("a"), method("b")])).toEqual([]);
    expect(bestOf("rate", [method("a")])).toEqual([]);
  });

  it("does not tell errors of rounding apart", () => {
    const three = [
      method("a", { max_error_deg: 3e-14 }),
      method("b", { max_error_deg: 8e-13 }),
      method("c", { max_error_deg: 0.02 }),
    ];
    expect(bestOf("largest", three)).toEqual(["a", "b"]);
    const matrices = [1e-16, 4e-15, 0.1].map((max_matrix_error, i) => method(`m${i}`, { max_matrix_error }));
    expect(bestOf("matrix", matrices)).toEqual(["m0", "m1"]);
  });

  it("is not marked where most share it", () => {
    const near = (rate: number): object => ({ peak: peaks(rate) });
    expect(bestOf("rate", [method("a"), method("b", near(10.001)), method("c"), method("d", near(11))])).toEqual([]);
    expect(bestOf("rate", [method("a"), method("b", near(10.001)), method("c", near(11))])).toEqual(["a", "b"]);
  });

  it("is no merit of a method that misses the flight", () => {
    const idle = method("idle", { exact_share: 0.1, peak: peaks(1) });
    const over = method("over", { feasible: false, peak: peaks(2) });
    expect(bestOf("rate", [idle, over, method("a", { peak: peaks(20) }), method("b", { peak: peaks(30) })])).toEqual([
      "a",
    ]);
    expect(fit(idle)).toBe(false);
  });

  it("leaves a method out that does not apply", () => {
    const none = method("none", { refusal: "no", max_error_deg: null, limit_violation_samples: null });
    expect(bestOf("violations", [none, method("a"), method("b", { limit_violation_samples: 4 })])).toEqual(["a"]);
  });
});

it("tells one method's options apart by their labels", () => {
  const closed = method("alm", { label: "alm:mode=closed_loop", peak: peaks(5) });
  expect(bestOf("rate", [method("alm"), closed])).toEqual(["alm:mode=closed_loop"]);
});

it("puts what can be flown first and keeps the order within", () => {
  const rows = [method("over", { feasible: false }), method("b"), method("near", { exact_share: 0.9 }), method("a")];
  expect(ranked(rows).map((row) => row.method)).toEqual(["b", "a", "near", "over"]);
});

it("sums up in one line", () => {
  const summary = (methods: MethodFigures[]): string => summaryOf({ report: { methods } } as never);
  expect(summary([method("a", { feasible: false })])).toMatch(/^No method/);
  expect(summary([method("a"), method("b")])).toMatch(/^All methods/);
  expect(summary([method("a"), method("b"), method("c", { exact_share: 0 })])).toBe(
    "a and b fly it exactly within the limits.",
  );
});
