// @vitest-environment happy-dom
import { fireEvent, screen } from "@testing-library/svelte";
import { describe, expect, it } from "vitest";
import { ApiError } from "../../net/errors";
import { TestConsole } from "../../testing/console";
import { leaseOf, session } from "../../testing/wire";
import Header from "./Header.svelte";
import Stops from "./Stops.svelte";
import Warnings from "./Warnings.svelte";

const running = session({ state: "running", lease: leaseOf("another") });
const press = (name: RegExp) => fireEvent.click(screen.getByRole("button", { name }));
const warning = () => screen.findByTestId("unconfirmed");

describe("Stop and E-stop", () => {
  it("ask for no lease and no fresh data", async () => {
    const console = new TestConsole({ stop: {}, estop: {} }).operate(running);
    console.lose();
    console.show(Stops, {});
    await press(/^Stop/);
    await press(/^E-stop/);
    expect(console.asked).toEqual([
      ["stop", "bench"],
      ["estop", "bench"],
    ]);
  });

  it("that nobody answered are said until one is confirmed", async () => {
    const answers = { estop: new ApiError(0, "The server did not answer within 2 s") as unknown };
    const console = new TestConsole(answers).operate(running);
    console.show(Stops, {});
    console.show(Warnings, {});
    await press(/^E-stop/);
    expect((await warning()).textContent).toContain("E-stop not confirmed: The server did not answer within 2 s");
    answers.estop = {};
    await press(/^Try again/);
    await expect.poll(() => screen.queryByTestId("unconfirmed")).toBeNull();
  });

  it("that nobody answered are settled by the state that they lead to, and by no other", async () => {
    const console = new TestConsole({ stop: new ApiError(0, "late") }).operate(running);
    console.show(Stops, {});
    console.show(Warnings, {});
    await press(/^Stop/);
    await warning();
    console.tell(running);
    await warning();
    console.tell(session({ state: "stopping" }));
    await expect.poll(() => screen.queryByTestId("unconfirmed")).toBeNull();
  });

  it("take the stop channel where it is open, and HTTP where it is not", async () => {
    const done = { command: "stop", state_before: "running", state_after: "stopping", revision: 2 } as const;
    const console = new TestConsole({ stop: done }).operate(running).openChannel(done, 1.5);
    console.show(Stops, {});
    console.show(Header, { choose: () => undefined });
    expect(screen.getByTestId("stop-round-trip").textContent).toContain("ms");
    await press(/^Stop/);
    console.channel = null;
    await press(/^Stop/);
    await expect
      .poll(() => console.asked)
      .toEqual([
        ["channel stop", "bench"],
        ["stop", "bench"],
      ]);
  });

  it("of which something is not known say what", async () => {
    const done = { command: "estop", state_before: "running", state_after: "running", revision: 2 } as const;
    const console = new TestConsole().operate(running);
    console.openChannel({ ...done, unknown: "the rig process has not answered" }, 1);
    console.show(Stops, {});
    console.show(Warnings, {});
    await press(/^E-stop/);
    expect((await warning()).textContent).toContain("the rig process has not answered");
  });

  it("of a rig that does not move are no alarm", async () => {
    const console = new TestConsole({ stop: new ApiError(409, "stop is not allowed while idle") }).operate(running);
    console.show(Stops, {});
    console.show(Warnings, {});
    await press(/^Stop/);
    expect(screen.queryByTestId("unconfirmed")).toBeNull();
    await expect.poll(() => console.stores.notices.all).toMatchObject([{ tone: "info" }]);
  });

  it("without a rig to send them to say so", async () => {
    const console = new TestConsole();
    console.show(Stops, {});
    console.show(Warnings, {});
    await press(/^Stop/);
    expect((await warning()).textContent).toContain("this console knows no rig yet");
    await press(/^Put away/);
    expect(screen.queryByTestId("unconfirmed")).toBeNull();
  });
});
