// @vitest-environment happy-dom
import { beforeEach, describe, expect, it } from "vitest";
import type { CommandDone } from "../contract/types";
import { World } from "../testing/world";
import { ANSWER_MS, StopChannel } from "./stopChannel";
import { PING_PERIOD_MS, SILENCE_MS } from "./keptSocket";

const DONE: CommandDone = { command: "estop", state_before: "running", state_after: "estopped", revision: 3 };

let world: World;
let trips: (number | null)[];
let channel: StopChannel;

function opened(): void {
  world.socket.onopen?.();
}

beforeEach(() => {
  world = new World();
  trips = [];
  channel = new StopChannel((ms) => trips.push(ms), world.around, "ws://rig/api/v1/stop");
});

describe("the stop channel", () => {
  it("is opened at once and tells its round trip every second", () => {
    opened();
    expect(world.socket.sent).toEqual([{ type: "ping", t: 0 }]);
    world.pass(4);
    world.socket.says({ type: "pong", t: 0, server_time: 1 });
    expect(trips).toEqual([4]);
    world.pass(PING_PERIOD_MS);
    expect(world.socket.sent.at(-1)).toMatchObject({ type: "ping" });
  });

  it("takes a stop and gives its answer, each to its own", async () => {
    opened();
    const [first, second] = [channel.press("stop", "a"), channel.press("estop", "b")];
    expect(world.socket.sent.slice(1)).toMatchObject([
      { type: "stop", rig: "a", id: 1 },
      { type: "estop", rig: "b", id: 2 },
    ]);
    world.socket.says({ type: "stopped", id: 2, rig: "b", done: DONE });
    world.socket.says({
      type: "problem",
      id: 1,
      problem: { type: "x", title: "Conflict", status: 409, detail: "idle" },
    });
    expect(await second).toEqual(DONE);
    await expect(first).rejects.toMatchObject({ status: 409, message: "idle" });
  });

  it("leaves a stop to HTTP while it is down, and where no answer comes", async () => {
    expect(await channel.press("stop", "a")).toBeNull();
    opened();
    const unanswered = channel.press("stop", "a");
    world.pass(ANSWER_MS);
    expect(await unanswered).toBeNull();
    const lost = channel.press("stop", "a");
    world.socket.onclose?.({ code: 1006, reason: "" });
    expect(await lost).toBeNull();
    expect(trips.at(-1)).toBeNull();
  });

  it("tells of a server that lets it in no longer, or never did, and of no other loss", () => {
    let refused = 0;
    channel = new StopChannel(
      () => undefined,
      world.around,
      "ws://rig/api/v1/stop",
      () => refused++,
    );
    opened();
    world.socket.onclose?.({ code: 1006, reason: "" }); // the network
    expect(refused).toBe(0);
    world.pass(1000);
    world.socket.onclose?.({ code: 1006, reason: "" }); // before it was open
    expect(refused).toBe(1);
    world.pass(2000);
    opened();
    world.socket.onclose?.({ code: 4401, reason: "this token or session has ended: sign in again" });
    expect(refused).toBe(2);
    channel.close();
    expect(refused).toBe(2);
  });

  it("that is closed stays so", () => {
    opened();
    channel.close();
    world.pass(60_000);
    expect([world.sockets.length, world.timers, trips.at(-1)]).toEqual([1, 0, null]);
  });

  it("comes back, also from a connection that died in silence", () => {
    opened();
    const dead = world.socket;
    world.pass(SILENCE_MS + 3 * PING_PERIOD_MS);
    expect(dead.closed).toBe(true);
    expect(world.socket).not.toBe(dead);
    opened();
    expect(world.socket.sent).toMatchObject([{ type: "ping" }]);
  });
});
