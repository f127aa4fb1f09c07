// @vitest-environment happy-dom
import { fireEvent, screen } from "@testing-library/svelte";
import { expect, it, vi } from "vitest";
import type { Curves } from "../../contract/types";
import { RunCurves } from "../../state/curves.svelte";
import { TestConsole } from "../../testing/console";
import RunPlots from "./RunPlots.svelte";

// What is drawn is for the browser tests: there is no canvas here.
vi.mock("../plots/SpanPlot.svelte", () => ({ default: () => undefined }));

const COLUMNS = ["time_s", "measured_base_deg"];
const ABOUT: Curves = {
  ready: true,
  progress: 1,
  samples: 3_600_000,
  duration_s: 3600,
  started: 0,
  record_sha256: "s",
  columns: COLUMNS,
  events: [
    { at_s: 1200, kind: "alarm", text: "inner is too fast", severity: "fault" },
    { at_s: 1800, kind: "command", text: "hold by ann", severity: null },
  ],
  events_left_out: 0,
  against: null,
};

function window(): ArrayBuffer {
  const view = new DataView(new ArrayBuffer(16 + 8 * 4));
  [0x31435046, 2, 2, 1].forEach((word, k) => view.setUint32(4 * k, word, true));
  [0, 3600, 1, 2].forEach((value, k) => view.setFloat64(16 + 8 * k, value, true));
  return view.buffer;
}

async function shown(
  first: Curves[] = [],
): Promise<{ curves: RunCurves; seek: ReturnType<typeof vi.fn>; asked: unknown[][] }> {
  const asked: unknown[][] = [];
  const answers = [...first, ABOUT];
  const curves = new RunCurves(
    {
      curves: (...given) => {
        asked.push(["curves", ...given]);
        return Promise.resolve(answers.length > 1 ? (answers.shift() as Curves) : ABOUT);
      },
      curvesWindow: (...given) => {
        asked.push(["window", ...given]);
        return Promise.resolve(window());
      },
    },
    "r1",
  );
  const seek = vi.fn();
  const others = [{ value: "plan:p", label: "Its plan" }];
  new TestConsole().show(RunPlots, { curves, rig: undefined, at: 1200, latest: null, seek, others });
  await expect.poll(() => curves.window).not.toBeNull();
  return { curves, seek, asked };
}

it("all of the run is shown first, keys zoom about the playhead, and 0 shows all again", async () => {
  const { curves, asked } = await shown();
  expect(asked).toContainEqual(["window", "r1", 0, 3600, 1200]);
  await fireEvent.keyDown(document.body, { key: "+" });
  expect(curves.view).toEqual([600, 2400]);
  await expect.poll(() => asked).toContainEqual(["window", "r1", 600, 2400, 1200]);
  await fireEvent.click(screen.getByRole("button", { name: "Zoom out" }));
  expect(curves.view).toEqual([0, 3600]);
  await fireEvent.keyDown(document.body, { key: "+" });
  await fireEvent.keyDown(document.body, { key: "0" });
  expect(curves.view).toEqual([0, 3600]);
});

it("a click on an event goes there; what is out of view is no button", async () => {
  const { curves, seek } = await shown();
  await fireEvent.click(screen.getByRole("button", { name: "20:00.0 inner is too fast" }));
  expect(seek).toHaveBeenCalledWith(1200);
  curves.show([0, 1500]);
  await expect.poll(() => screen.queryByRole("button", { name: /hold by ann/ })).toBeNull();
});

it("curves that are still being made are asked for until they are ready", async () => {
  const { asked } = await shown([{ ...ABOUT, ready: false, progress: 0.42 }]);
  expect(asked.filter(([what]) => what === "curves")).toHaveLength(2);
  expect(screen.queryByText(/Reading the record/)).toBeNull();
});

it("a run is compared with its plan on request, and no more once that is taken back", async () => {
  const { curves, asked } = await shown();
  await fireEvent.change(screen.getByRole("combobox", { name: "Compare with" }), { target: { value: "plan:p" } });
  await expect.poll(() => asked).toContainEqual(["curves", "r1", "plan:p"]);
  await fireEvent.change(screen.getByRole("combobox", { name: "Compare with" }), { target: { value: "" } });
  expect(curves.against).toBeNull();
});
