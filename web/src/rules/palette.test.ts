import { expect, it } from "vitest";
import type { Circumstances } from "./commands";
import { matching, paletteOf } from "./palette";

const NOW: Circumstances = {
  role: null,
  state: "armed",
  allowed: ["start", "move", "home", "disarm"],
  freshness: "fresh",
  leased: true,
  plan: true,
  unacknowledged: 0,
  busy: false,
  otherwise: null,
  holdable: true,
};
const offered = (now: Partial<Circumstances> = {}) =>
  paletteOf({
    pages: ["operate", "plans", "runs"],
    rigs: ["bench"],
    live: false,
    now: { ...NOW, ...now },
    take: { enabled: true },
  });
const named = (label: string, now: Partial<Circumstances> = {}) => offered(now).find((each) => each.label === label);

it("has the pages, the rigs and every command, and says why one may not be given", () => {
  expect(named("Plans")?.may).toEqual({ enabled: true });
  expect(named("Operate bench")?.deed).toEqual({ kind: "rig", rig: "bench" });
  expect(named("Start")?.may).toEqual({ enabled: true });
  expect(named("Resume")?.may).toEqual({ enabled: false, why: "Not allowed while armed" });
  expect(named("Start", { role: "viewer" })?.may).toEqual({ enabled: false, why: "Your role is viewer" });
});

it("asks before what sets the rig in motion, and never before a stop", () => {
  expect([named("Start")?.asks, named("Home")?.asks, named("Arm")?.asks]).toEqual([true, true, true]);
  expect([named("Disarm")?.asks, named("Hold")?.asks]).toEqual([false, false]);
  for (const stop of ["Stop", "E-stop"]) {
    const entry = named(stop, { role: "viewer", state: null, freshness: "stale", leased: false });
    expect([entry?.may, entry?.asks]).toEqual([{ enabled: true }, false]);
  }
});

it("takes control or releases it, whichever there is", () => {
  expect(named("Release control")).toBeTruthy();
  expect(named("Take control")).toBeUndefined();
  expect(named("Take control", { leased: false })).toBeTruthy();
});

it("is searched by words in any order, what begins with them first", () => {
  const found = (typed: string): string[] => matching(offered(), typed).map(({ label }) => label);
  expect(found("st")[0]).toBe("Stop");
  expect(found("bench operate")).toEqual(["Operate bench"]);
  expect(found("no such thing")).toEqual([]);
  expect(found("")).toHaveLength(offered().length);
});
