import { describe, expect, it } from "vitest";
import contract from "../../../docs/openapi.json";
import type { CommandName } from "../contract/types";
import { COMMANDS, nextStep, recoveryStep, shownCommands, verdict, type Circumstances } from "./commands";

const ARMED: Circumstances = {
  role: null,
  state: "armed",
  allowed: ["start", "move", "home", "disarm", "acknowledge", "load", "hold", "reset"],
  freshness: "fresh",
  leased: true,
  plan: true,
  unacknowledged: 0,
  busy: false,
  otherwise: null,
  holdable: true,
};
const NOTHING: Circumstances = {
  role: "viewer",
  state: null,
  allowed: [],
  freshness: "stale",
  leased: false,
  plan: false,
  unacknowledged: 3,
  busy: true,
  otherwise: "another is loaded",
  holdable: false,
};

const enabled = (command: CommandName, now: Partial<Circumstances>): boolean =>
  verdict(command, { ...ARMED, ...now }).enabled;

describe("stop and E-stop", () => {
  it.each(["stop", "estop"] as const)("%s may always be given", (command) => {
    expect(verdict(command, NOTHING)).toEqual({ enabled: true });
  });
});

describe("a command", () => {
  it("needs the session to allow it", () => {
    expect(enabled("start", {})).toBe(true);
    expect(verdict("resume", ARMED)).toEqual({ enabled: false, why: "Not allowed while armed" });
  });

  it("needs an operator, where people sign in, before all else", () => {
    expect(verdict("start", { ...ARMED, role: "viewer", state: null })).toEqual({
      enabled: false,
      why: "Your role is viewer",
    });
    expect(enabled("start", { role: "operator" })).toBe(true);
    expect(enabled("start", { role: "admin" })).toBe(true);
  });

  it("needs the lease", () => {
    expect(verdict("start", { ...ARMED, leased: false })).toEqual({ enabled: false, why: "Take control first" });
  });

  it("waits for the one before", () => {
    expect(enabled("start", { busy: true })).toBe(false);
  });

  it("that holds waits for none", () => {
    expect(enabled("hold", { busy: true })).toBe(true);
  });

  it("that holds is off for a rig whose jerk limits a hold would not keep, and says what to do", () => {
    expect(verdict("hold", { ...ARMED, holdable: false })).toEqual({
      enabled: false,
      why: "A rig with jerk limits is not held on its path: stop it (Esc)",
    });
    expect(enabled("start", { holdable: false })).toBe(true);
  });

  it("that sets the rig in motion has no key", () => {
    expect(COMMANDS.filter(({ motion, key }) => motion && key)).toEqual([]);
  });

  it.each(["arm", "start", "resume", "move", "home", "jog"] as const)(
    "that moves the rig is refused on stale data: %s",
    (command) => {
      const now = { allowed: [command] };
      expect(enabled(command, now)).toBe(true);
      expect(enabled(command, { ...now, freshness: "late" })).toBe(true);
      expect(enabled(command, { ...now, freshness: "stale" })).toBe(false);
    },
  );

  it.each(["hold", "disarm", "connect", "unload"] as const)(
    "that calms the rig may be given on stale data: %s",
    (command) => {
      expect(enabled(command, { allowed: [command], freshness: "stale" })).toBe(true);
    },
  );

  it("unknown to the console counts as motion", () => {
    const unknown = "pirouette" as CommandName; // of a newer server
    expect(enabled(unknown, { allowed: [unknown], freshness: "stale" })).toBe(false);
  });
});

it("load needs a plan that can be flown", () => {
  expect(enabled("load", {})).toBe(true);
  expect(enabled("load", { plan: false })).toBe(false);
});

it("acknowledge needs an alarm, reset needs none to be waiting", () => {
  expect(enabled("acknowledge", {})).toBe(false);
  expect(enabled("acknowledge", { unacknowledged: 1 })).toBe(true);
  expect(enabled("reset", {})).toBe(true);
  expect(enabled("reset", { unacknowledged: 1 })).toBe(false);
});

it("the main button follows the run, and the way back from a trip", () => {
  expect(
    (["disconnected", "idle", "ready", "armed", "running", "held"] as const).map((state) => nextStep(state)),
  ).toEqual(["connect", "load", "arm", "start", "hold", "resume"]);
  expect(nextStep("stopping")).toBeNull();
  expect(nextStep(null)).toBeNull();
  expect(recoveryStep("faulted", 2)).toBe("acknowledge");
  expect(recoveryStep("estopped", 0)).toBe("reset");
  expect(recoveryStep("running", 2)).toBeNull();
});

it("every button is a command of the contract", () => {
  const known = Object.values(contract.components.schemas).flatMap((schema) =>
    "properties" in schema && "command" in schema.properties && "const" in schema.properties.command
      ? [schema.properties.command.const]
      : [],
  );
  expect(known).toContain("estop");
  for (const { name } of COMMANDS) expect(known).toContain(name);
});

describe("a live source", () => {
  it("puts go live in the place of start", () => {
    const names = (live: boolean): string[] => shownCommands(live, 0).map(({ name }) => name);
    expect(names(false)).toContain("start");
    expect(names(false)).not.toContain("go_live");
    expect(names(true)).toContain("go_live");
    expect(names(true)).not.toContain("start");
    expect(nextStep("armed", true)).toBe("go_live");
  });
});

it("acknowledge stands in the place of reset while an alarm waits", () => {
  const names = (waiting: number): string[] => shownCommands(false, waiting).map(({ name }) => name);
  expect(names(1)).toContain("acknowledge");
  expect(names(1)).not.toContain("reset");
  expect(names(0)).toContain("reset");
});
