// @vitest-environment happy-dom
import { fireEvent, screen, within } from "@testing-library/svelte";
import { tick } from "svelte";
import { beforeEach, describe, expect, it } from "vitest";
import type { AlarmRecord } from "../../contract/types";
import { TestConsole } from "../../testing/console";
import { alarm, givenLease, ourLease, session } from "../../testing/wire";
import Alarms from "./Alarms.svelte";

beforeEach(() => sessionStorage.clear());

const ALLOWED = ["acknowledge", "shelve", "unshelve"];

function record(given: Partial<AlarmRecord> = {}): AlarmRecord {
  return {
    ...alarm({ severity: "warning", code: "late", message: "late by 3 ms" }),
    id: "a-1",
    rig: "bench",
    standing: true,
    ...given,
  };
}

const page = (rows: AlarmRecord[], next: string | null = null): object => ({ alarms: { rows, next } });

async function inControl(answers: object, given: Parameters<typeof session>[0] = {}): Promise<TestConsole> {
  const console = new TestConsole({ lease: givenLease(ourLease()), command: {}, ...answers });
  console.operate(session({ lease: ourLease(), allowed: ALLOWED, ...given }));
  await console.stores.operated.lease.take();
  console.show(Alarms, {});
  return console;
}

const history = async (): Promise<HTMLElement[]> =>
  within(await screen.findByRole("list", { name: "Alarm history" })).getAllByRole("listitem");
const asked = (console: TestConsole, what: string): unknown[][] =>
  console.asked.filter(([request]) => request === what).map(([, ...given]) => given);

describe("the history", () => {
  it("tells what stands, what was shelved, and who has seen what", async () => {
    await inControl(
      page([
        record({ id: "a-3", number: 3, count: 4, last_time_s: 50 }),
        record({ id: "a-2", number: 2, standing: false, shelved: true }),
        record({ id: "a-1", number: 1, standing: false, acknowledged_by: "ann", acknowledged_s: 60 }),
      ]),
    );
    const [first, second, third] = (await history()).map((row) => row.textContent);
    expect(first).toContain("standing");
    expect(first).toContain("waits for acknowledge");
    expect(first).toContain("4 times");
    expect(second).toContain("shelved");
    expect(third).toContain("acknowledged by ann");
  });

  it("acknowledges one alarm of the operated rig, under the lease", async () => {
    const console = await inControl(page([record({ number: 7 })]), { alarms: [alarm({ number: 7 })] });
    await history();
    await fireEvent.click(screen.getByRole("button", { name: "Acknowledge" }));
    expect(asked(console, "command")).toEqual([
      ["bench", "acknowledge", { numbers: [7] }, { epoch: 3, sequence: 1, secret: "a-secret" }],
    ]);
  });

  it("leads to the rig whose alarm it is, where that is another", async () => {
    await inControl(page([record({ rig: "other" })]));
    await history();
    expect(screen.getByRole("link", { name: "Operate other" }).getAttribute("href")).toBe("/operate/other");
    expect(screen.queryByRole("button", { name: "Acknowledge" })).toBeNull();
  });

  it("shelves a warning for a time, with a reason; a fault has no such button", async () => {
    const console = await inControl(
      page([
        record({ frame: "inner" }),
        record({ id: "a-2", number: 2, severity: "fault", message: "inner is too fast" }),
      ]),
    );
    await history();
    await fireEvent.click(screen.getByRole("button", { name: "Shelve…" }));
    const dialog = within(screen.getByRole("dialog"));
    await fireEvent.change(dialog.getByLabelText("For"), { target: { value: "240" } });
    await fireEvent.input(dialog.getByLabelText("Reason"), { target: { value: "a known fan" } });
    await fireEvent.click(dialog.getByRole("button", { name: "Shelve" }));
    expect(asked(console, "command")[0]?.slice(0, 3)).toEqual([
      "bench",
      "shelve",
      { code: "late", frame: "inner", minutes: expect.any(Number) as number, reason: "a known fan" },
    ]);
    await expect.poll(() => screen.queryByRole("dialog")).toBeNull();
  });

  it("is asked for by what the filter says", async () => {
    const console = await inControl(page([record()]));
    await history();
    await fireEvent.click(screen.getByRole("button", { name: "Standing" }));
    await fireEvent.input(screen.getByLabelText("Code"), { target: { value: "following error" } });
    await tick();
    expect(asked(console, "alarms").at(-1)?.[0]).toMatchObject({ standing: true, code: "following_error", rig: null });
  });

  it("goes on where the page before ended", async () => {
    const console = await inControl(page([record()], "1~a-1"));
    await history();
    await fireEvent.click(screen.getByRole("button", { name: "Show older" }));
    expect(asked(console, "alarms").at(-1)?.[1]).toBe("1~a-1");
  });
});

it("the shelves say how long they last yet, and are taken away", async () => {
  const until_s = Date.now() / 1000 + 3600;
  const shelf = { code: "late", frame: null, since_s: until_s - 7200, until_s, by: "ann", reason: "a known fan" };
  const console = await inControl(page([]), { shelves: [shelf] });
  await fireEvent.click(screen.getByRole("button", { name: /^Shelves/ }));
  const shelves = within(screen.getByRole("list", { name: "Shelves of bench" }));
  expect(shelves.getByRole("listitem").textContent).toMatch(/a known fan.*by ann.*(59|60) min|1 h 0 min/s);
  await fireEvent.click(shelves.getByRole("button", { name: "Unshelve" }));
  expect(asked(console, "command")[0]?.slice(0, 3)).toEqual(["bench", "unshelve", { code: "late", frame: null }]);
});

it("what was damaged and put into quarantine is told", async () => {
  const damaged = "plan 3f is damaged (it is cut off): it is in /data/quarantine/3f";
  const health = { status: "degraded", version: "1", disk: { free_bytes: 5e9, alarm_bytes: 1e9 }, warnings: [damaged] };
  await inControl({ ...page([]), health });
  await fireEvent.click(screen.getByRole("button", { name: /^Server/ }));
  expect(await screen.findByText(damaged)).toBeTruthy();
  expect(screen.getByText("degraded")).toBeTruthy();
});

it("commands are listed with what was refused, a page at a time", async () => {
  const line = {
    id: 5,
    at: "2026-11-29T10:00:00Z",
    who: "ann",
    rig: "bench",
    command: "go_live",
    args: {},
    address: "10.0.0.7",
  };
  const states = { state_before: "armed", state_after: "armed", lease_epoch: null, lease_sequence: null };
  const audit = { rows: [{ ...line, ...states, accepted: false, detail: "another has control" }], next: "5" };
  const console = await inControl({ ...page([]), audit });
  await fireEvent.click(screen.getByRole("button", { name: "Commands" }));
  expect((await screen.findByRole("table", { name: "Commands" })).textContent).toMatch(
    /10\.0\.0\.7.*go live.*another has control/,
  );
  await fireEvent.click(screen.getByRole("button", { name: "Show older" }));
  expect(asked(console, "audit").at(-1)).toEqual(["5"]);
});
