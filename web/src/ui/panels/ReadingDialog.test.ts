// @vitest-environment happy-dom
import { fireEvent, screen } from "@testing-library/svelte";
import { expect, it, vi } from "vitest";
import type { HowToRead, ReadingPreview } from "../../contract/types";
import { ApiError } from "../../net/errors";
import { TestConsole } from "../../testing/console";
import { remember } from "../../rules/reading";
import ReadingDialog from "./ReadingDialog.svelte";

const REFUSED: ReadingPreview = {
  format: "mcap",
  table: "/front",
  tables: ["/front", "/rear"],
  names: ["time"],
  units: ["s"],
  head: [["0.0"]],
  profiles: [],
  profile: null,
  columns: null,
  problem: "2 attitudes",
  remedy: "source",
  flight: null,
};
const READ: ReadingPreview = {
  ...REFUSED,
  problem: null,
  remedy: null,
  flight: {
    samples: 1,
    duration_s: 0,
    convention: "enu",
    statement: "taken as enu",
    warnings: [],
    time_s: [],
    yaw_deg: [],
    pitch_deg: [],
    roll_deg: [],
    q: [],
  },
};
// happy-dom has no canvas to plot on: what is drawn there goes nowhere.
const nowhere = new Proxy({}, { get: () => () => ({ width: 0 }), set: () => true });
HTMLCanvasElement.prototype.getContext = (() => nowhere) as never;

const file = new File([""], "two.mcap");
const storing = (): HTMLButtonElement => screen.getByRole("button", { name: "Store the flight" });

it("lets one of several sources be chosen, and stores what was read", async () => {
  const store = vi.fn();
  const lookAt = (how: unknown) => ((how as HowToRead).source === "/rear" ? READ : REFUSED);
  const console = new TestConsole({ lookAt });
  console.show(ReadingDialog, { file, first: {}, store, close: () => undefined });
  expect((await screen.findByRole("status")).textContent).toBe("2 attitudes");
  expect(storing().disabled).toBe(true);
  await fireEvent.change(screen.getByLabelText("Source"), { target: { value: "/rear" } });
  expect(await screen.findByText("taken as enu")).toBeTruthy();
  await fireEvent.click(storing());
  expect(store).toHaveBeenCalledWith(file, { source: "/rear" });
});

it("stores nothing while it is read, nor where the server refuses to read it so", async () => {
  const store = vi.fn();
  const lookAt = (how: unknown) => ((how as HowToRead).bridge_gaps ? new ApiError(422, "too long", []) : READ);
  new TestConsole({ lookAt }).show(ReadingDialog, { file, first: {}, store, close: () => undefined });
  await screen.findByText("taken as enu");
  await fireEvent.click(screen.getByLabelText("Fly through gaps by interpolation"));
  await fireEvent.click(storing());
  expect((await screen.findByRole("status")).textContent).toBe("too long");
  expect(screen.queryByText("taken as enu")).toBeNull();
  await fireEvent.click(storing());
  expect(store).not.toHaveBeenCalled();
});

const HAND: ReadingPreview = { ...REFUSED, tables: [""], names: ["t", "a", "b", "c"], units: [null, null, null, null] };

const MAP = {
  axes: "ned",
  time: { column: "t", unit: "s", epoch: "first" },
  euler: { columns: ["a", "b", "c"], order: "ZYX", unit: "deg" },
  quaternion: null,
};

it("lets the columns be given by hand, shows the vehicle, and saves them as a profile", async () => {
  localStorage.clear();
  const store = vi.fn();
  const lookAt = (how: unknown) => ((how as HowToRead).columns ? { ...READ, names: HAND.names } : HAND);
  const console = new TestConsole({ lookAt, profiles: [], saveProfile: {} });
  console.show(ReadingDialog, { file, first: {}, store, close: () => undefined });
  await fireEvent.click(await screen.findByRole("button", { name: "Columns by hand" }));
  await fireEvent.change(screen.getByLabelText("Second angle, about y"), { target: { value: "t" } });
  expect(screen.getByText("Each column stands for one thing")).toBeTruthy();
  await fireEvent.change(screen.getByLabelText("Second angle, about y"), { target: { value: "b" } });
  expect(await screen.findByLabelText("The vehicle at 0.00 s")).toBeTruthy();
  await fireEvent.input(screen.getByLabelText("Name of the profile"), { target: { value: "ours" } });
  await vi.waitFor(() => expect(storing().disabled).toBe(false));
  await fireEvent.click(storing());
  expect(store).toHaveBeenCalledWith(file, { columns: JSON.stringify(MAP) });
  await fireEvent.click(screen.getByRole("button", { name: "Save as profile" }));
  expect(console.asked).toContainEqual(["saveProfile", "ours", "", MAP]);
});

it("reads a file as this browser read the last one like it", async () => {
  localStorage.clear();
  remember(HAND.names, { columns: JSON.stringify(MAP) });
  const lookAt = (how: unknown) => ((how as HowToRead).columns ? READ : HAND);
  new TestConsole({ lookAt, profiles: [] }).show(ReadingDialog, {
    file,
    first: {},
    store: vi.fn(),
    close: () => undefined,
  });
  expect(await screen.findByText("taken as enu")).toBeTruthy();
});

it("offers what mends a refusal", async () => {
  localStorage.clear();
  const gap: ReadingPreview = { ...REFUSED, problem: "a gap", remedy: "bridge_gaps" };
  const lookAt = (how: unknown) => ((how as HowToRead).bridge_gaps ? READ : gap);
  new TestConsole({ lookAt, profiles: [] }).show(ReadingDialog, {
    file,
    first: {},
    store: vi.fn(),
    close: () => undefined,
  });
  await fireEvent.click(await screen.findByRole("button", { name: "Fly through the gaps" }));
  expect(await screen.findByText("taken as enu")).toBeTruthy();
});
