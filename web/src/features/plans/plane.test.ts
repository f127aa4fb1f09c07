// @vitest-environment happy-dom
import { fireEvent, screen } from "@testing-library/svelte";
import { afterEach, beforeEach, expect, it, vi } from "vitest";
import type { Plan, Plane, PlanSamples } from "../../contract/types";
import { ApiError } from "../../net/errors";
import { Player } from "../../state/player.svelte";
import { TestConsole } from "../../testing/console";
import PlanPlane from "./PlanPlane.svelte";

const SENTENCE = "Tightest at 1.000 s: the outer frame's rate limit, 4 % left.";
const text = (bytes: number[]): string => btoa(String.fromCharCode(...bytes.map((value) => value & 255)));
const PLANE: Plane = {
  time_s: [0, 1],
  base_deg: [-90, 90],
  rows: 3,
  margin: text([1, 2, 3, 4, 5, -6, 10, 20, 30, 40, 50, 60]),
  limits: text(Array.from({ length: 12 }, () => 5)),
  needles: [{ time_s: 0.5, base_deg: 20, half_width_deg: 3 }],
  needles_left_out: 0,
  path: { base_deg: [0, 0], side: [0, 0], margin: [1, 4], limit: [5, 5] },
  tightest: { time_s: 1, margin: 4, frame: "outer", limit: "rate", sentence: SENTENCE },
};
const plan = { id: "p1", rig: "bench", trajectory_name: "loop" } as Plan;
const samples = { time_s: [0, 1], angles_deg: { base: [0, 0] }, lead_in_s: 0, lead_out_s: 0 } as unknown as PlanSamples;
const player = (): Player => new Player(() => [0, 1]);

/** On the screen at once: a page of a test has no screen. */
class Seen {
  constructor(private readonly told: (entries: { isIntersecting: boolean }[]) => void) {}
  observe(): void {
    queueMicrotask(() => this.told([{ isIntersecting: true }]));
  }
  disconnect(): void {
    // nothing is kept
  }
}

/** A canvas that takes whatever is drawn; this document has none. */
function paper(): object {
  const drawn = { data: { set: () => undefined }, width: 10 };
  return new Proxy({}, { get: () => () => drawn, set: () => true });
}

beforeEach(() => {
  vi.stubGlobal("IntersectionObserver", Seen);
  vi.stubGlobal("Path2D", function path() {
    return paper();
  });
  vi.spyOn(HTMLCanvasElement.prototype, "getContext").mockReturnValue(paper() as never);
});
afterEach(() => {
  vi.unstubAllGlobals();
  vi.restoreAllMocks();
});

it("the plane says where the plan is tightest and goes there, and what a base angle would leave", async () => {
  const console = new TestConsole({ planPlane: PLANE });
  const at = player();
  console.show(PlanPlane, { plan, samples, player: at, redundant: true });
  expect(await screen.findByText(SENTENCE)).toBeTruthy();
  expect(console.asked).toEqual([["planPlane", "p1"]]);
  const reading = screen.getByTestId("plane-reading");
  expect(reading.textContent).toContain("At 0.000 s with the base at 0.0 deg a path can leave 2 % at most");
  await fireEvent.click(screen.getByRole("button", { name: "Show where" }));
  expect(at.at).toBe(1);
  const slider = screen.getByRole("slider", { name: /Base angle looked at/ });
  await fireEvent.input(slider, { target: { value: "90" } });
  expect(reading.textContent).toContain("with the base at 90.0 deg no path passes: the outer frame's rate limit.");
  expect(slider.getAttribute("aria-valuetext")).toBe(reading.textContent);
  await fireEvent.click(screen.getByRole("button", { name: "The better side" }));
  expect(reading.textContent).toContain("a path can leave 60 % at most");
  await fireEvent.click(screen.getByRole("button", { name: "Back to the plan" }));
  expect(reading.textContent).toContain("base at 0.0 deg");
  expect(reading.textContent).toContain("The plan leaves 4 % of the outer frame's rate limit about then.");
});

it("a rig of three axes is told why it has no plane, and nothing is asked", () => {
  const console = new TestConsole({ planPlane: PLANE });
  console.show(PlanPlane, { plan, samples, player: player(), redundant: false });
  expect(screen.getByText(/bench has three axes/)).toBeTruthy();
  expect(console.asked).toEqual([]);
});

it("why there is no plane is said", async () => {
  const console = new TestConsole({ planPlane: new ApiError(409, "rig bench is another") });
  console.show(PlanPlane, { plan, samples, player: player(), redundant: true });
  expect((await screen.findByRole("alert")).textContent).toContain("rig bench is another");
});
