// @vitest-environment happy-dom
import { fireEvent, screen, within } from "@testing-library/svelte";
import { tick } from "svelte";
import { beforeEach, describe, expect, it } from "vitest";
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
