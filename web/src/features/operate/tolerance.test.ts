// @vitest-environment happy-dom
import { fireEvent, screen } from "@testing-library/svelte";
import { expect, it } from "vitest";
import { TestConsole } from "../../testing/console";
import { effect } from "../../testing/wire";
import ToleranceField from "../../ui/panels/ToleranceField.svelte";

it("a tolerance begins where it is enough, and every move of the slider shows what it does", async () => {
  const told = (wanted: number | null) =>
    effect(wanted === null ? {} : { tolerance_deg: wanted, flown: effect().recorded });
  const console = new TestConsole({ tolerance: told });
  console.show(ToleranceField, { flight: "f", toleranceDeg: null });
  expect(console.asked).toEqual([]);
  await fireEvent.click(screen.getByRole("checkbox", { name: /Within a tolerance/ }));
  expect(console.asked).toEqual([["tolerance", "f", null]]);
  const slider = await screen.findByRole("slider", { name: "Tolerance" });
  expect(slider.getAttribute("aria-valuetext")).toBe("0.05 deg");
  expect(screen.getByText("24,500 → 152 deg/s²")).toBeTruthy();
  await fireEvent.input(slider, { target: { value: "1" } });
  expect(console.asked).toContainEqual(["tolerance", "f", 0.5]);
  expect(await screen.findByText("24,500 → 24,500 deg/s²")).toBeTruthy();
  await fireEvent.click(screen.getByRole("checkbox"));
  expect(screen.queryByRole("slider")).toBeNull();
});

it("says when a tolerance is too tight, and why the server did not answer", async () => {
  const console = new TestConsole({ tolerance: effect({ within_tolerance: false }) });
  const shown = console.show(ToleranceField, { flight: "f", toleranceDeg: null });
  await fireEvent.click(screen.getByRole("checkbox"));
  expect(await screen.findByText(/Too tight/)).toBeTruthy();
  shown.unmount();
  const refused = new TestConsole({ tolerance: new Error("busy") });
  refused.show(ToleranceField, { flight: "f", toleranceDeg: null });
  await fireEvent.click(screen.getByRole("checkbox"));
  expect((await screen.findByRole("alert")).textContent).toBe("busy");
});
