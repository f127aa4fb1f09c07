import { expect, it } from "vitest";
import contract from "../../../docs/openapi.json";
import { differs, otherwise, stepsToArmed, stepsVerdict, type Chosen, type Loaded } from "./choice";
import { verdict, type Circumstances } from "./commands";

const LOADED: Loaded = { plan_id: "p1", name: "Loop", live: false };
const LIVE: Loaded = { plan_id: "", name: "", live: true };
const chosen = (given: Partial<Chosen> = {}): Chosen => ({ live: false, flight: "f", plan: "p1", ...given });
const STATES = [...contract.components.schemas.State.enum, null] as Circumstances["state"][];

const now = (given: Partial<Circumstances>): Circumstances => ({
  role: null,
  state: "armed",
  allowed: ["start", "go_live", "disarm"],
  freshness: "fresh",
  leased: true,
  plan: true,
  unacknowledged: 0,
  busy: false,
  otherwise: null,
  holdable: true,
  ...given,
});

it("what is loaded is what is chosen, or it differs: another plan, no plan of the flight yet, a live source", () => {
  expect(differs(LOADED, chosen())).toBe(false);
  expect(differs(LOADED, chosen({ plan: "p2" }))).toBe(true);
  expect(differs(LOADED, chosen({ plan: null }))).toBe(true);
  expect(differs(LOADED, chosen({ live: true }))).toBe(true);
  expect(differs(LIVE, chosen({ live: true, plan: null }))).toBe(false);
  expect(differs(LIVE, chosen())).toBe(true);
});

it("nothing differs where nothing is loaded, or nothing was chosen", () => {
  expect(differs(null, chosen())).toBe(false);
  expect(differs(LOADED, chosen({ flight: null, plan: null }))).toBe(false);
});

it("start and go live are off where they would fly something else, and say what is loaded", () => {
  const why = otherwise(LOADED, chosen({ plan: "p2" }));
  expect(why).toContain("Loop");
  expect(verdict("start", now({ otherwise: why }))).toEqual({ enabled: false, why });
  expect(verdict("go_live", now({ otherwise: why }))).toEqual({ enabled: false, why });
  expect(verdict("start", now({})).enabled).toBe(true);
  expect(verdict("disarm", now({ otherwise: why })).enabled).toBe(true);
});

it("the steps end armed, and there are none where the rig moves or is tripped", () => {
  const possible = STATES.filter((state) => stepsToArmed(state, false).length > 0);
  expect(new Set(possible)).toEqual(new Set(["idle", "ready", "armed"]));
  for (const state of possible) expect(stepsToArmed(state, false).at(-1)).toBe("arm");
  expect(stepsToArmed("armed", true)).toEqual([]);
  expect(stepsToArmed("ready", true)).toEqual(["arm"]);
});

it("the steps ask for control, fresh data and a plan that can be flown", () => {
  const steps = stepsToArmed("armed", false);
  const may = (given: Partial<Circumstances>): boolean => stepsVerdict(steps, now(given)).enabled;
  expect(may({})).toBe(true);
  expect([may({ leased: false }), may({ freshness: "stale" }), may({ plan: false })]).toEqual([false, false, false]);
  expect(stepsVerdict([], now({ state: "running" }))).toEqual({ enabled: false, why: "Not while running" });
});
