// @vitest-environment happy-dom
import { fireEvent, screen, within } from "@testing-library/svelte";
import { tick } from "svelte";
import { beforeEach, describe, expect, it } from "vitest";
import type { Plan } from "../../contract/types";
import { ApiError } from "../../net/errors";
import { STALE_MS } from "../../rules/freshness";
import { TestConsole } from "../../testing/console";
import { alarm, givenLease, leaseOf, ourLease, RIG, session } from "../../testing/wire";
import AlarmsPanel from "./AlarmsPanel.svelte";
import CommandBar from "./CommandBar.svelte";
import FlightPanel from "./FlightPanel.svelte";

beforeEach(() => sessionStorage.clear());

const command = (name: string): HTMLButtonElement => {
  const found = document.querySelector<HTMLButtonElement>(`[data-command="${name}"]`);
  if (!found) throw new Error(`no button ${name}`);
  return found;
};
const enabled = (): (string | undefined)[] =>
  [...document.querySelectorAll<HTMLButtonElement>("[data-command]")].flatMap((each) =>
    each.disabled ? [] : [each.dataset["command"]],
  );

/** A console that has taken control of a rig whose session is this. */
async function inControl(given: Parameters<typeof session>[0] = {}, answers: object = {}): Promise<TestConsole> {
  const console = new TestConsole({ lease: givenLease(ourLease()), command: {}, ...answers });
  console.operate(session({ lease: ourLease(), ...given }));
  await console.stores.operated.lease.take();
  return console;
}

describe("the command bar", () => {
  it("of who only watches has no command, and says what is missing", () => {
    const console = new TestConsole().operate(session({ lease: leaseOf("another") }));
    console.show(CommandBar, {});
    expect(enabled()).toEqual([]);
    expect(command("start").title).toBe("Take control first");
    expect(command("arm").title).toBe("Not allowed while armed");
  });

  it("has what the session allows, and the next step as its main button", async () => {
    const console = await inControl({ state: "held", allowed: ["resume", "disarm"] });
    console.show(CommandBar, {});
    expect(enabled()).toEqual(["resume", "disarm"]);
    expect([...document.querySelectorAll(".button.main")]).toEqual([command("resume")]);
  });

  it("sets nothing in motion on old data, but still holds and disarms", async () => {
    const console = await inControl({ state: "running", allowed: ["hold", "resume", "home", "disarm"] });
    console.show(CommandBar, {});
    console.grow(2 * STALE_MS);
    await tick();
    expect(enabled()).toEqual(["hold", "disarm"]);
    expect(command("home").title).toContain("stale");
  });

  it("sends each command with the next token of the lease", async () => {
    const console = await inControl();
    console.show(CommandBar, {});
    await fireEvent.click(command("start"));
    await fireEvent.click(command("disarm"));
    expect(console.asked.filter(([what]) => what === "command")).toEqual([
      ["command", "bench", "start", {}, { epoch: 3, sequence: 1, secret: "a-secret" }],
      ["command", "bench", "disarm", {}, { epoch: 3, sequence: 2, secret: "a-secret" }],
    ]);
  });

  it("keeps the key that loading a live source is answered, until another rig is operated", async () => {
    const console = await inControl({}, { command: { live_key: "the-key" } });
    const { operated } = console.stores;
    await operated.command("load", { live: { method: "exact" } });
    expect(operated.liveKey).toBe("the-key");
    console.operate(session({ rig: "other" }));
    expect(operated.liveKey).toBeNull();
  });

  it("says what was refused", async () => {
    const console = await inControl({}, { command: new ApiError(409, "start is not allowed while running") });
    console.show(CommandBar, {});
    await fireEvent.click(command("start"));
    expect(console.stores.notices.all).toMatchObject([{ tone: "problem", text: "start is not allowed while running" }]);
  });

  it("moves the frames through its dialog, within their limits", async () => {
    const console = await inControl();
    console.stores.library.rigs = [RIG];
    console.show(CommandBar, {});
    await fireEvent.click(command("move"));
    const dialog = within(screen.getByRole("dialog", { name: "Move the frames" }));
    const inner: HTMLInputElement = dialog.getByLabelText("inner");
    expect([inner.min, inner.max]).toEqual(["-170", "170"]);
    await fireEvent.input(inner, { target: { value: "12.5" } });
    await fireEvent.click(dialog.getByRole("button", { name: "Move" }));
    expect(console.asked.at(-1)?.slice(0, 4)).toEqual(["command", "bench", "move", { target_deg: [0, 0, 0, 12.5] }]);
    await expect.poll(() => screen.queryByRole("dialog")).toBeNull();
  });
});

describe("control", () => {
  it("is asked for where another has it, and taken over only when a person says so", async () => {
    const held = new ApiError(409, "held by another");
    const asked = givenLease(leaseOf("another"), "asked");
    const console = new TestConsole({ lease: (action: string) => (action === "request" ? asked : held) });
    console.operate(session({ lease: leaseOf("another") }));
    console.show(CommandBar, {});
    await fireEvent.click(screen.getByRole("button", { name: "Ask for control" }));
    console.tell(session({ lease: leaseOf("another", { requested_by: [ourLease().holder ?? ""] }) }));
    await fireEvent.click(await screen.findByRole("button", { name: "Take over…" }));
    expect(console.asked.map(([, , action]) => action)).toEqual(["take", "request"]);
    const dialog = within(screen.getByRole("dialog"));
    await fireEvent.input(dialog.getByLabelText("Reason"), { target: { value: " the shift is over " } });
    await fireEvent.click(dialog.getByRole("button", { name: "Take over" }));
    expect(console.asked.at(-1)).toEqual(["lease", "bench", "takeover", undefined, "the shift is over"]);
  });
});

it("a viewer sees what is there, and what a role forbids says so; nothing is asked of the server for it", async () => {
  const console = new TestConsole().operate(session({ alarms: [alarm()] }));
  const person = { name: "vic", role: "viewer", via: "session", until: null } as const;
  console.stores.identity.take({ people: true, provider: null, person });
  console.show(CommandBar, {});
  console.show(AlarmsPanel, {});
  console.show(FlightPanel, {});
  expect(enabled()).toEqual([]);
  const refused = [/^Take control/, "Acknowledge all", "Plan"].map((name) => screen.getByRole("button", { name }));
  expect([command("start"), ...refused].map(({ title }) => title)).toEqual(Array(4).fill("Your role is viewer"));
  expect(screen.getByLabelText<HTMLInputElement>("Flight file").disabled).toBe(true);
  await fireEvent.click(command("start"));
  expect(console.asked).toEqual([]);
});

describe("alarms", () => {
  const standing = alarm({ number: 7, first: true, frame: "inner", value: 512.5, limit: 500, unit: "deg/s" });

  it("say what they are of, and which wait", async () => {
    const console = await inControl({
      state: "faulted",
      alarms: [standing],
      history: [standing, alarm({ number: 3 })],
    });
    console.show(AlarmsPanel, {});
    const [first, past] = screen.getAllByRole("listitem");
    expect(first?.textContent).toContain("first cause, rate limit, inner: 512.500 past 500.000 deg/s");
    expect(first?.textContent).toContain("waits for acknowledge");
    expect(past?.textContent).not.toContain("waits");
    await fireEvent.click(screen.getByRole("button", { name: "Acknowledge all" }));
    expect(console.asked.at(-1)?.slice(0, 3)).toEqual(["command", "bench", "acknowledge"]);
  });

  it("that nobody waits for are none", () => {
    new TestConsole().operate(session()).show(AlarmsPanel, {});
    expect(screen.getByText("No standing alarms")).toBeTruthy();
    expect(screen.queryByRole("button", { name: "Acknowledge all" })).toBeNull();
  });

  it("tell of a rig process that does not answer", async () => {
    const silent = session();
    new TestConsole().operate({ ...silent, health: { ...silent.health, rig_alive: false } }).show(AlarmsPanel, {});
    await fireEvent.click(screen.getByRole("button", { name: /Rig process/ }));
    expect(screen.getByText("not answering")).toBeTruthy();
  });

  it("tell how long the drive takes, and the call that hangs", async () => {
    const rig = session();
    const drive = { read_us: 41, read_max_us: 2210, write_us: 12, write_max_us: 90, hangs: "write" };
    new TestConsole().operate({ ...rig, health: { ...rig.health, drive } }).show(AlarmsPanel, {});
    await fireEvent.click(screen.getByRole("button", { name: /Rig process/ }));
    expect(screen.getByText("Drive hangs in").nextElementSibling?.textContent).toBe("write");
    expect(screen.getByText(/^Drive read/).nextElementSibling?.textContent).toBe("41 / 2210 µs");
  });
});

describe("what is loaded and what is chosen", () => {
  const planOf = (id: string, name: string): Plan =>
    ({
      id,
      trajectory: name,
      trajectory_name: name,
      rig: "bench",
      method: "plan",
      status: "done",
      flyable: true,
      refusal: null,
      remedy: null,
      report: null,
      created_at: "2026-11-01T12:00:00Z",
    }) as unknown as Plan;
  const ref = { plan_id: "p1", name: "Loop", live: false, plan_hash: "h", rig_hash: "r", duration_s: 10 };
  const allowed = ["start", "disarm", "unload", "load", "arm"];

  it("are one: Start names its flight, and is off while another is chosen; one step loads and arms that, asked first", async () => {
    const console = await inControl({ plan: ref, allowed });
    const { library } = console.stores;
    library.planning.put({ ...planOf("p2", "Roll") });
    library.planning.put({ ...planOf("p1", "Loop") });
    console.show(CommandBar, {});
    console.show(FlightPanel, {});
    await expect.poll(() => library.plan).toBe("p1");
    expect(command("start").textContent).toContain("Loop");
    expect(command("start").disabled).toBe(false);
    library.chooseTrajectory("Roll");
    await tick();
    library.choosePlan("p2");
    await tick();
    expect(command("start").disabled).toBe(true);
    expect(command("start").title).toContain("Loop");
    await fireEvent.click(screen.getByRole("button", { name: /^Load and arm/ }));
    const question = within(screen.getByRole("dialog", { name: /Load and arm Roll/ }));
    expect(console.asked.filter(([what]) => what === "command")).toEqual([]);
    await fireEvent.click(question.getByRole("button", { name: "Load and arm" }));
    await expect
      .poll(() => console.asked.filter(([what]) => what === "command").map(([, , name, args]) => [name, args]))
      .toEqual([
        ["disarm", {}],
        ["unload", {}],
        ["load", { plan: "p2" }],
        ["arm", {}],
      ]);
  });

  it("where nothing is loaded one press loads and arms what is chosen", async () => {
    const console = await inControl({ state: "idle", allowed: ["load"] });
    const { library } = console.stores;
    library.planning.put(planOf("p1", "Loop"));
    library.chooseTrajectory("Loop");
    library.choosePlan("p1");
    console.show(FlightPanel, {});
    await fireEvent.click(screen.getByRole("button", { name: "Load and arm" }));
    await expect.poll(() => console.asked.filter(([what]) => what === "command")).toHaveLength(2);
    expect(screen.queryByRole("dialog")).toBeNull();
  });

  it("a step that is refused ends the steps", async () => {
    const console = await inControl(
      { state: "idle", allowed: ["load"] },
      { command: new ApiError(409, "another rig's plan") },
    );
    const { library } = console.stores;
    library.planning.put(planOf("p1", "Loop"));
    library.chooseTrajectory("Loop");
    library.choosePlan("p1");
    console.show(FlightPanel, {});
    await fireEvent.click(screen.getByRole("button", { name: "Load and arm" }));
    await expect.poll(() => console.stores.notices.all).toHaveLength(1);
    expect(console.asked.filter(([what]) => what === "command")).toHaveLength(1);
  });
});
