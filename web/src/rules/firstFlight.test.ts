import { expect, it } from "vitest";
import { firstFlight, type FirstNow } from "./firstFlight";

const next = (now: Partial<FirstNow>): string | undefined =>
  firstFlight({ leased: false, state: null, flights: 0, plan: false, ...now }).find(({ done }) => !done)?.label;

it("leads from nothing to a flight, one step after another", () => {
  expect(next({})).toBe("Take control");
  expect(next({ leased: true, state: "disconnected" })).toBe("Connect");
  expect(next({ leased: true, state: "idle" })).toBe("Drop a flight");
  expect(next({ leased: true, state: "idle", flights: 1 })).toBe("Plan");
  expect(next({ leased: true, state: "ready", flights: 1, plan: true })).toBe("Load and arm");
  expect(next({ leased: true, state: "armed", flights: 1, plan: true })).toBe("Start");
  expect(next({ leased: true, state: "running", flights: 1, plan: true })).toBeUndefined();
});
