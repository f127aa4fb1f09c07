import { beforeEach, describe, expect, it } from "vitest";
import type { Snapshot } from "../contract/types";
import type { LinkEvent } from "./link";
import { backoffMs, PING_PERIOD_MS, SILENCE_MS } from "./keptSocket";
import { RECORD_MS, Stream } from "./stream";
import { World } from "../testing/world";
import { HEADER_BYTES, type Batch } from "./telemetry";

const HELLO = {
  type: "hello",
  schema: "fullpose.stream/1",
  server_time: 0,
  rig: "r",
  session: { revision: 1, state: "idle" } as Snapshot,
  fields: ["wall_ns"],
  record: { size: 8, fields: [{ name: "wall_ns", type: "<i8", count: 1, offset: 0 }] },
};

function telemetry(seq: number, wallNs: bigint, serverTime: number): ArrayBuffer {
  const view = new DataView(new ArrayBuffer(HEADER_BYTES + 8));
  view.setUint32(0, 0x31545046, true);
  view.setUint16(4, 1, true);
  view.setUint16(6, 1, true);
  view.setBigUint64(8, BigInt(seq), true);
  view.setFloat64(16, serverTime, true);
  view.setBigInt64(HEADER_BYTES, wallNs, true);
  return view.buffer;
}

describe("the stream", () => {
  let world: World;
  let events: LinkEvent[];
  let batches: Batch[];
  let stream: Stream;

  beforeEach(() => {
    world = new World();
    events = [];
    batches = [];
    const listener = {
      link: (event: LinkEvent) => void events.push(event),
      batch: (batch: Batch) => void batches.push(batch),
    };
    stream = new Stream("ws://rig", listener, world.around);
  });

  const types = (): string[] => events.map(({ type }) => type);

  it("subscribes to binary frames at 30 Hz after hello", () => {
    world.socket.says(HELLO);
    expect(world.socket.sent[0]).toMatchObject({
      type: "subscribe",
      topics: ["telemetry", "session"],
      rate_hz: 30,
      encoding: "binary",
      since_seq: null,
    });
    expect(types()).toEqual(["connecting", "opened"]);
  });

  it("gives frames on, with their age as they were sent", () => {
    world.socket.says(HELLO);
    world.socket.says(telemetry(5, 1_000_000_000n, 1.004));
    expect(batches).toHaveLength(1);
    const frame = events.at(-1);
    expect(frame).toMatchObject({ type: "frame", seq: 5, dropped: 0 });
    expect(frame?.type === "frame" && frame.ageAtSendMs).toBeCloseTo(4, 6);
  });

  it("measures the round trip by ping and pong", () => {
    world.socket.says(HELLO);
    const ping = world.socket.sent.find(({ type }) => type === "ping");
    world.now += 12;
    world.socket.says({ type: "pong", t: ping?.t, server_time: 0 });
    expect(events.at(-1)).toEqual({ type: "pong", roundTripMs: 12 });
    world.pass(PING_PERIOD_MS);
    expect(world.socket.sent.filter(({ type }) => type === "ping")).toHaveLength(2);
  });

  it("comes back after a loss, waiting longer each time, and at once resets that after hello", () => {
    world.socket.onclose?.({ code: 1006, reason: "" });
    expect(events.at(-1)).toEqual({ type: "closed", reason: "connection closed (1006)" });
    world.pass(249);
    expect(world.sockets).toHaveLength(1);
    world.pass(1);
    expect(world.sockets).toHaveLength(2);
    world.socket.onclose?.({ code: 1006, reason: "" });
    world.pass(499);
    expect(world.sockets).toHaveLength(2);
    world.pass(1);
    expect(world.sockets).toHaveLength(3);
    world.socket.says(HELLO);
    world.socket.onclose?.({ code: 1006, reason: "" });
    world.pass(250);
    expect(world.sockets).toHaveLength(4);
  });

  it("takes a silent server for a lost one", () => {
    world.socket.says(HELLO);
    const first = world.socket;
    world.pass(SILENCE_MS + 2 * PING_PERIOD_MS);
    expect(first.closed).toBe(true);
    expect(types()).toContain("closed");
  });

  it("refuses another schema and says so", () => {
    world.socket.says({ ...HELLO, schema: "fullpose.stream/2" });
    expect(events.at(-1)).toMatchObject({ type: "problem" });
    expect(world.socket.sent).toHaveLength(0);
  });

  it("reports a broken frame and goes on", () => {
    world.socket.says(HELLO);
    world.socket.says(new ArrayBuffer(3));
    expect(events.at(-1)).toMatchObject({ type: "problem" });
    world.socket.says(telemetry(6, 0n, 0));
    expect(batches).toHaveLength(1);
  });

  it("leaves nothing running once closed", () => {
    world.socket.says(HELLO);
    stream.close();
    expect(world.socket.closed).toBe(true);
    expect(world.timers).toBe(0);
    world.pass(60_000);
    expect(world.sockets).toHaveLength(1);
  });
});

describe("a replay", () => {
  it("is given time to be read, and its clock is set before the subscription", () => {
    const world = new World();
    const told: unknown[] = [];
    const stream = new Stream(
      "ws://x",
      {
        link: () => undefined,
        batch: () => undefined,
        replay: (of) => {
          told.push(of.run);
          stream.control({ type: "seek", time_s: 3 });
        },
        replayed: ({ playing }) => told.push(playing),
      },
      world.around,
      30,
      "binary",
      RECORD_MS,
    );
    stream.control({ type: "pause" }); // not before hello: there is no clock yet
    world.pass(SILENCE_MS * 4);
    expect(world.socket.closed).toBe(false);
    world.socket.says({ ...HELLO, replay: { run: "r1", duration_s: 9, started: 0, scene: "/scene/r1~0/" } });
    expect(world.socket.sent.map(({ type }) => type)).toEqual(["seek", "subscribe", "ping"]);
    world.socket.says({ type: "replay", time_s: 3, playing: false, factor: 1 });
    expect(told).toEqual(["r1", false]);
    stream.close();
  });
});

it("backoff doubles from 250 ms to 5 s, spread by a quarter either way", () => {
  expect([1, 2, 3, 4, 5, 6, 20].map((attempt) => backoffMs(attempt, 0.5))).toEqual([
    250, 500, 1000, 2000, 4000, 5000, 5000,
  ]);
  expect(backoffMs(1, 0)).toBe(187.5);
  expect(backoffMs(1, 1)).toBe(312.5);
});
