import { describe, expect, it } from "vitest";
import type { RecordDescription, TelemetryMessage } from "../contract/types";
import { decodeBinary, decodeJson, FrameError, HEADER_BYTES, layoutOf, sampleAt } from "./telemetry";

/** A record with a hole after `state`, as the server's has. */
const RECORD: RecordDescription = {
  size: 56,
  fields: [
    { name: "seq", type: "<u8", count: 1, offset: 0 },
    { name: "time_ns", type: "<i8", count: 1, offset: 8 },
    { name: "state", type: "|u1", count: 1, offset: 16 },
    { name: "measured", type: "<f8", count: 4, offset: 24 },
  ],
};

function frame(
  rows: { seq: number; timeNs: number; state: number; measured: number[] }[],
  magic = "FPT1",
): ArrayBuffer {
  const buffer = new ArrayBuffer(HEADER_BYTES + rows.length * RECORD.size);
  const view = new DataView(buffer);
  for (let i = 0; i < magic.length; i++) view.setUint8(i, magic.charCodeAt(i));
  view.setUint16(4, 1, true);
  view.setUint16(6, rows.length, true);
  view.setBigUint64(8, BigInt(rows.at(-1)?.seq ?? 0), true);
  view.setFloat64(16, 1700000000.25, true);
  view.setBigUint64(24, 7n, true);
  rows.forEach((row, i) => {
    const at = HEADER_BYTES + i * RECORD.size;
    view.setBigUint64(at, BigInt(row.seq), true);
    view.setBigInt64(at + 8, BigInt(row.timeNs), true);
    view.setUint8(at + 16, row.state);
    row.measured.forEach((value, k) => view.setFloat64(at + 24 + 8 * k, value, true));
  });
  return buffer;
}

describe("binary frames", () => {
  const layout = layoutOf(RECORD);

  it("are read field by field, holes skipped", () => {
    const batch = decodeBinary(
      frame([
        { seq: 41, timeNs: 2e9, state: 5, measured: [1, -2, 3, 0.1] },
        { seq: 42, timeNs: 3e9, state: 6, measured: [4, 5, NaN, 1e-300] },
      ]),
      layout,
    );
    expect(batch).toMatchObject({ count: 2, seq: 42, serverTime: 1700000000.25, dropped: 7 });
    expect(batch.columns.get("state")?.data).toEqual(Float64Array.of(5, 6));
    expect(sampleAt(batch, 0)).toMatchObject({ seq: 41, timeS: 2, measured: [1, -2, 3, 0.1] });
    expect(sampleAt(batch, 1).measured).toEqual([4, 5, NaN, 1e-300]);
  });

  it("leave fields that the server does not send not a number", () => {
    const sample = sampleAt(decodeBinary(frame([{ seq: 1, timeNs: 0, state: 0, measured: [0, 0, 0, 0] }]), layout), 0);
    expect(sample.solveErrorDeg).toBeNaN();
    expect(sample.demand.every(Number.isNaN)).toBe(true);
  });

  it.each([
    ["cut in the header", frame([]).slice(0, 20)],
    ["cut in a record", frame([{ seq: 1, timeNs: 0, state: 0, measured: [0, 0, 0, 0] }]).slice(0, -1)],
    ["of something else", frame([], "XXXX")],
  ])("%s are refused", (_, buffer) => {
    expect(() => decodeBinary(buffer, layout)).toThrow(FrameError);
  });

  it("of an unknown version are refused, and say which", () => {
    const buffer = frame([]);
    new DataView(buffer).setUint16(4, 9, true);
    expect(() => decodeBinary(buffer, layout)).toThrow(/version 9/);
  });
});

describe("the record's description", () => {
  it.each([
    ["big-endian", { name: "x", type: ">f8", count: 1, offset: 0 }],
    ["of an unknown type", { name: "x", type: "<c16", count: 1, offset: 0 }],
    ["outside of the record", { name: "x", type: "<f8", count: 4, offset: 40 }],
  ])("a field %s is refused", (_, field) => {
    expect(() => layoutOf({ size: 56, fields: [field] })).toThrow(FrameError);
  });
});

describe("JSON frames", () => {
  it("give the same samples, null for not a number, sample_seq for seq", () => {
    const message = {
      type: "telemetry",
      seq: 9,
      server_time: 5,
      dropped: 0,
      sample_seq: [8, 9],
      time_ns: [1e9, 2e9],
      state: [1, 1],
      measured: [
        [1, 2, 3, 4],
        [5, null, 7, 8],
      ],
    } as unknown as TelemetryMessage;
    const batch = decodeJson(message, layoutOf(RECORD));
    expect(batch.count).toBe(2);
    expect(sampleAt(batch, 0)).toMatchObject({ seq: 8, measured: [1, 2, 3, 4] });
    expect(sampleAt(batch, 1)).toMatchObject({ seq: 9, timeS: 2, measured: [5, NaN, 7, 8] });
  });
});
