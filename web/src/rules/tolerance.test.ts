import { expect, it } from "vitest";
import type { Plan } from "../contract/types";
import { effect } from "../testing/wire";
import { accelerationsOf, cautionOf, placeOf, rangeOf, suggestionFor, toleranceAt } from "./tolerance";

it("a slider goes from where a tolerance does not help to far beyond where it does", () => {
  const range = rangeOf(effect());
  expect(range).toEqual({ low: 0.02, high: 0.5 });
  expect(toleranceAt(0, range)).toBe(0.02);
  expect(toleranceAt(1, range)).toBe(0.5);
  for (const value of [0.02, 0.05, 0.11, 0.5]) expect(toleranceAt(placeOf(value, range), range)).toBe(value);
  expect(placeOf(7, range)).toBe(1);
  expect(placeOf(0.001, range)).toBe(0);
});

it("a clean flight has a slider, too, and nothing beyond a quarter turn", () => {
  expect(rangeOf({ suggested_tolerance_deg: null, tolerance_floor_deg: null })).toEqual({ low: 0.05, high: 1 });
  expect(rangeOf({ suggested_tolerance_deg: 40, tolerance_floor_deg: 30 }).high).toBe(90);
});

it("tells accelerations before and after, and when a tolerance is too tight", () => {
  expect(accelerationsOf(effect())).toBe("24,500 → 152 deg/s²");
  expect(cautionOf(effect())).toBeNull();
  expect(cautionOf(effect({ within_tolerance: false, deviation_deg: { max: 0.0412, rms: 0.01 } }))).toBe(
    "Too tight: the flight behind the noise is up to 0.041 deg away. Below 0.04 deg none helps. 0.05 deg is enough.",
  );
});

it("a plan that was refused for its recording has a suggestion, until it has that tolerance", () => {
  const plan = (feasible: boolean, suggested: number | null, tolerance: number | null): Plan =>
    ({ tolerance_deg: tolerance, report: { feasible, suggested_tolerance_deg: suggested } }) as Plan;
  expect(suggestionFor(plan(false, 0.05, null))).toBe(0.05);
  expect(suggestionFor(plan(false, 0.05, 0.01))).toBe(0.05);
  expect(suggestionFor(plan(false, 0.05, 0.05))).toBeNull();
  expect(suggestionFor(plan(true, 0.05, null))).toBeNull();
  expect(suggestionFor(plan(false, null, null))).toBeNull();
  expect(suggestionFor({ tolerance_deg: null, report: null } as Plan)).toBeNull();
});
