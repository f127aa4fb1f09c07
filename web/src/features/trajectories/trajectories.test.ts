// @vitest-environment happy-dom
import { fireEvent, screen, within } from "@testing-library/svelte";
import { expect, it } from "vitest";
import { TestConsole } from "../../testing/console";
import { diagnosisOf, FLIGHT } from "../../testing/wire";
import Trajectories from "./Trajectories.svelte";

it("a flight is deleted once a person says so", async () => {
  const console = new TestConsole({ trajectories: { rows: [FLIGHT], next: null }, deleteTrajectory: undefined });
  await console.stores.library.flights.refresh();
  console.show(Trajectories, {});
  await fireEvent.click(await screen.findByRole("button", { name: "Delete the flight" }));
  await fireEvent.click(within(screen.getByRole("dialog")).getByRole("button", { name: "Delete" }));
  await expect.poll(() => console.asked).toContainEqual(["deleteTrajectory", "f"]);
});

it("a flight says what is wrong with it, and is asked about for the rig that is operated", async () => {
  const sentence = "Samples are held, 50.0 Hz written out at 400 Hz.";
  const found = diagnosisOf({ findings: [{ code: "held", level: "warning", sentence }] });
  const console = new TestConsole({ trajectories: { rows: [FLIGHT], next: null }, diagnosis: found });
  await console.stores.library.flights.refresh();
  console.stores.operated.open("bench");
  console.show(Trajectories, {});
  expect((await screen.findByText(sentence)).closest("li")?.className).toContain("warning");
  expect(console.asked).toContainEqual(["diagnosis", "f", "bench"]);
  expect(screen.getByRole("img", { name: "Steps between samples of loop, 5.000 to 15.000 ms" })).toBeTruthy();
});

it("a diagnosis that fails says why, and the flight is still there", async () => {
  const console = new TestConsole({ trajectories: { rows: [FLIGHT], next: null }, diagnosis: new Error("too busy") });
  await console.stores.library.flights.refresh();
  console.show(Trajectories, {});
  expect((await screen.findByRole("alert")).textContent).toContain("could not be looked at");
  expect(screen.getByRole("button", { name: "Plan and fly" })).toBeTruthy();
});

it("flights are searched, one that was found is shown, and all are there again", async () => {
  const other = { ...FLIGHT, sha256: "g", name: "roll", tags: ["north"] };
  const pages = { rows: [FLIGHT, other], next: null };
  const found = (wanted: { q?: string } | undefined): object => (wanted?.q ? { rows: [other], next: null } : pages);
  const console = new TestConsole({ trajectories: found });
  await console.stores.library.flights.refresh();
  console.show(Trajectories, {});
  const field = screen.getByRole("searchbox", { name: "Search flights" });
  await fireEvent.input(field, { target: { value: "roll" } });
  await expect.poll(() => screen.queryByRole("button", { name: "loop" })).toBeNull();
  expect(console.asked).toContainEqual(["trajectories", null, { q: "roll", tag: null }]);
  expect(screen.getByRole("region", { name: "Flight roll" })).toBeTruthy();
  await fireEvent.input(field, { target: { value: "" } });
  expect(await screen.findByRole("button", { name: "loop" })).toBeTruthy();
});

it("a flight is given a tag, by which others are found", async () => {
  const tagged = { ...FLIGHT, tags: ["north"] };
  const console = new TestConsole({ trajectories: { rows: [FLIGHT], next: null }, labelTrajectory: tagged });
  await console.stores.library.flights.refresh();
  console.show(Trajectories, {});
  const field = screen.getByRole<HTMLInputElement>("textbox", { name: "Add a tag" });
  await fireEvent.input(field, { target: { value: "north" } });
  await fireEvent.submit(field);
  expect(console.asked).toContainEqual(["labelTrajectory", "f", { tags: ["north"] }]);
  await fireEvent.click(await screen.findByRole("button", { name: "north" }));
  expect(console.asked).toContainEqual(["trajectories", null, { q: null, tag: "north" }]);
  await fireEvent.click(await screen.findByRole("button", { name: "Any tag" }));
  await expect.poll(() => screen.queryByRole("button", { name: "Any tag" })).toBeNull();
});
