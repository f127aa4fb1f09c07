// @vitest-environment happy-dom
import { fireEvent, screen } from "@testing-library/svelte";
import { describe, expect, it } from "vitest";
import { ApiError } from "../../net/errors";
import { TestConsole } from "../../testing/console";
import { FLIGHT } from "../../testing/wire";
import DropZone from "./DropZone.svelte";

const file = new File(["time_s,yaw_deg,pitch_deg,roll_deg\n"], "loop.csv");
const choose = (...files: File[]) => fireEvent.change(screen.getByLabelText("Flight file"), { target: { files } });

describe("a flight", () => {
  it("is sent, and how much of it has been is told", async () => {
    const console = new TestConsole({ trajectories: { rows: [FLIGHT], next: null } });
    console.show(DropZone, {});
    await choose(file);
    const [what, sent, how, progress] = console.asked.at(-1) ?? [];
    expect([what, sent, how]).toEqual(["upload", file, {}]);
    (progress as (fraction: number) => void)(0.5);
    expect((await screen.findByText(/50/)).textContent).toContain("50");
  });

  it("that is stored is chosen, and what was found in it is said", async () => {
    const stored = { ...FLIGHT, warnings: [{ code: "gap", message: "a gap of 0.2 s" }] };
    const console = new TestConsole({ trajectories: { rows: [stored], next: null }, upload: stored });
    console.show(DropZone, {});
    await choose(file);
    await expect.poll(() => console.stores.notices.all).toMatchObject([{ text: "loop: a gap of 0.2 s" }]);
    expect(console.stores.library.trajectory).toBe("f");
  });

  it("that is refused says where it is wrong", async () => {
    const where = { where: "pitch_deg", message: "not a number", line: 17 };
    const console = new TestConsole({ upload: new ApiError(422, "The file cannot be read", [where]) });
    console.show(DropZone, {});
    await choose(file);
    expect((await screen.findByRole("alert")).textContent).toBe(
      "The file cannot be read (line 17, pitch_deg: not a number)",
    );
  });

  it("of two at once is not sent", async () => {
    const console = new TestConsole();
    console.show(DropZone, {});
    await choose(file, file);
    expect(await screen.findByRole("alert")).toBeTruthy();
    expect(console.asked).toEqual([]);
  });
});
