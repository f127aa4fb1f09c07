// @vitest-environment happy-dom
import { fireEvent, screen, within } from "@testing-library/svelte";
import { expect, it } from "vitest";
import { TestConsole } from "../../testing/console";
import { FLIGHT } from "../../testing/wire";
import Trajectories from "./Trajectories.svelte";

it("a flight is deleted once a person says so", async () => {
  const console = new TestConsole({ trajectories: { rows: [FLIGHT], next: null }, deleteTrajectory: undefined });
  await console.stores.library.flights.refresh();
  console.show(Trajectories, {});
  await fireEvent.click(await screen.findByRole("button", { name: "Delete the flight" }));
  await fireEvent.click(within(screen.getByRole("dialog")).getByRole("button", { name: "Delete" }));
  await expect.poll(() => console.asked).toContainEqual(["deleteTrajectory", "f"]);
});
