// @vitest-environment happy-dom
import { fireEvent, screen, within } from "@testing-library/svelte";
import { expect, it } from "vitest";
import { ApiError } from "../../net/errors";
import { TestConsole } from "../../testing/console";
import { runOf } from "../../testing/wire";
import Runs from "./Runs.svelte";

const page = (pinned: boolean): object => ({ runs: { rows: [runOf({ pinned })], next: null }, run: runOf({ pinned }) });

it("a run is deleted once a person says so, in a dialog of the console's own", async () => {
  const console = new TestConsole({ ...page(false), deleteRun: undefined });
  console.show(Runs, {});
  await fireEvent.click(await screen.findByRole("button", { name: "Delete the run" }));
  expect(console.asked.map(([request]) => request)).not.toContain("deleteRun");
  await fireEvent.click(within(screen.getByRole("dialog")).getByRole("button", { name: "Delete" }));
  await expect.poll(() => console.asked).toContainEqual(["deleteRun", "r1"]);
});

it("a run that cannot be deleted stays, and why is said", async () => {
  const console = new TestConsole({ ...page(false), deleteRun: new ApiError(409, "run r1 is being flown") });
  console.show(Runs, {});
  await fireEvent.click(await screen.findByRole("button", { name: "Delete the run" }));
  await fireEvent.click(within(screen.getByRole("dialog")).getByRole("button", { name: "Delete" }));
  await expect.poll(() => console.stores.notices.all).toMatchObject([{ text: "run r1 is being flown" }]);
  expect(screen.getByRole("button", { name: "Delete the run" })).toBeTruthy();
});

it("a run is pinned, and a pinned one cannot be deleted", async () => {
  const console = new TestConsole({ ...page(true), runs: { rows: [runOf()], next: null }, pinRun: undefined });
  console.show(Runs, {});
  await fireEvent.click(await screen.findByRole("button", { name: "Pin the run" }));
  await expect.poll(() => screen.queryByRole("button", { name: "Unpin the run" })).not.toBeNull();
  expect(console.asked).toContainEqual(["pinRun", "r1"]);
  expect(screen.getByRole<HTMLButtonElement>("button", { name: "Delete the run" }).disabled).toBe(true);
});

it("runs are searched, also by a tag in the list, and nothing found is said", async () => {
  const tagged = runOf({ tags: ["north"] });
  const found = (wanted: { q?: string } | undefined): object => ({ rows: wanted?.q ? [] : [tagged], next: null });
  const console = new TestConsole({ runs: found });
  console.show(Runs, {});
  await fireEvent.click(await screen.findByRole("button", { name: "north" }));
  expect(console.asked).toContainEqual(["runs", null, { q: null, tag: "north" }]);
  await fireEvent.input(screen.getByRole("searchbox"), { target: { value: "ben" } });
  expect(await screen.findByText("Nothing found")).toBeTruthy();
  expect(console.asked).toContainEqual(["runs", null, { q: "ben", tag: "north" }]);
});
