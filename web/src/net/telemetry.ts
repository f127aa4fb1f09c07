/** Telemetry records: parsing of the two encodings into columns. No socket, no clock. */
import type { RecordDescription, TelemetryMessage } from "../contract/types";

export class FrameError extends Error {
  override name = "FrameError";
}

export interface Column {
  /** Values a record: 1, or 4 for one a frame of the rig. */
  readonly width: number;
  /** Row-major, count x width. */
  readonly data: Float64Array;
}

/** The records of one telemetry frame, oldest first. */
export interface Batch {
  readonly count: number;
  readonly seq: number;
  /** Server's wall clock as it sent the frame [s]. */
  readonly serverTime: number;
  /** Records this client has lost so far, as the server counts them. */
  readonly dropped: number;
  readonly columns: ReadonlyMap<string, Column>;
}

interface Field {
  name: string;
  offset: number;
  width: number;
  size: number;
  read: (view: DataView, at: number) => number;
}

export interface Layout {
  readonly fields: readonly Field[];
  readonly itemSize: number;
}

const READERS: Record<string, [number, (view: DataView, at: number) => number]> = {
  u1: [1, (v, at) => v.getUint8(at)],
  u2: [2, (v, at) => v.getUint16(at, true)],
  u4: [4, (v, at) => v.getUint32(at, true)],
  u8: [8, (v, at) => Number(v.getBigUint64(at, true))],
  i1: [1, (v, at) => v.getInt8(at)],
  i4: [4, (v, at) => v.getInt32(at, true)],
  i8: [8, (v, at) => Number(v.getBigInt64(at, true))],
  f4: [4, (v, at) => v.getFloat32(at, true)],
  f8: [8, (v, at) => v.getFloat64(at, true)],
};

/** Where each field lies in a record, from the description in `hello`. Raises FrameError on a format it does not know. */
export function layoutOf(record: RecordDescription): Layout {
  const fields = record.fields.map(({ name, type, count: width, offset }): Field => {
    const reader = READERS[type.slice(1)];
    if (!reader || type.startsWith(">")) throw new FrameError(`field ${name} has an unknown type: ${type}`);
    const [size, read] = reader;
    if (offset + width * size > record.size) throw new FrameError(`field ${name} ends outside of the record`);
    return { name, offset, width, size, read };
  });
  return { fields, itemSize: record.size };
}

export const HEADER_BYTES = 32;
const MAGIC = 0x31545046; // "FPT1", little-endian
const VERSION = 1;

/** One binary frame: header {magic u4, version u2, count u2, seq u8, server_time f8, dropped u8}, then the records. */
export function decodeBinary(buffer: ArrayBuffer, layout: Layout): Batch {
  if (buffer.byteLength < HEADER_BYTES) throw new FrameError(`a frame of ${buffer.byteLength} bytes has no header`);
  const view = new DataView(buffer);
  if (view.getUint32(0, true) !== MAGIC) throw new FrameError("not a telemetry frame");
  const version = view.getUint16(4, true);
  if (version !== VERSION) throw new FrameError(`telemetry version ${version}, this console reads ${VERSION}`);
  const count = view.getUint16(6, true);
  if (buffer.byteLength !== HEADER_BYTES + count * layout.itemSize) {
    throw new FrameError(`${buffer.byteLength} bytes do not hold ${count} records of ${layout.itemSize}`);
  }
  const columns = new Map<string, Column>();
  for (const field of layout.fields) {
    const data = new Float64Array(count * field.width);
    for (let row = 0; row < count; row++) {
      const at = HEADER_BYTES + row * layout.itemSize + field.offset;
      for (let i = 0; i < field.width; i++) data[row * field.width + i] = field.read(view, at + i * field.size);
    }
    columns.set(field.name, { width: field.width, data });
  }
  return {
    count,
    seq: Number(view.getBigUint64(8, true)),
    serverTime: view.getFloat64(16, true),
    dropped: Number(view.getBigUint64(24, true)),
    columns,
  };
}

/** The same from a JSON message, in which null stands for not-a-number. */
export function decodeJson(message: TelemetryMessage, layout: Layout): Batch {
  const columns = new Map<string, Column>();
  let count = 0;
  for (const { name, width } of layout.fields) {
    // `seq` of the message is the frame's own.
    const rows: unknown = message[(name === "seq" ? "sample_seq" : name) as keyof TelemetryMessage];
    if (!Array.isArray(rows)) continue;
    count = rows.length;
    const data = new Float64Array(count * width);
    (rows as unknown[]).flat().forEach((value, i) => (data[i] = typeof value === "number" ? value : NaN));
    columns.set(name, { width, data });
  }
  return { count, seq: message.seq, serverTime: message.server_time, dropped: message.dropped, columns };
}

/** Four values, one a frame: base, outer, middle, inner. */
export type Four = readonly [number, number, number, number];

/** One record, in the units of the surface: degrees and seconds. */
export interface Sample {
  seq: number;
  /** Monotonic time of the rig process. */
  timeS: number;
  wallS: number;
  /** Time in the flight; not a number where none is loaded. */
  pathTimeS: number;
  /** Speed along the path: 1 running, 0 held. */
  pathScale: number;
  demand: Four;
  demandRate: Four;
  measured: Four;
  measuredRate: Four;
  solveErrorDeg: number;
  trackingErrorDeg: number;
  followingErrorDeg: Four;
  margin: number;
  latenessUs: number;
  /** Bits, see `FLAG`. */
  flags: number;
}

/** Record `row` of a batch; a field the server does not send is not a number. */
export function sampleAt(batch: Batch, row: number): Sample {
  const one = (name: string): number => batch.columns.get(name)?.data[row] ?? NaN;
  const four = (name: string): Four => {
    const column = batch.columns.get(name);
    const at = (i: number): number => column?.data[row * column.width + i] ?? NaN;
    return [at(0), at(1), at(2), at(3)];
  };
  return {
    seq: one("seq"),
    timeS: one("time_ns") / 1e9,
    wallS: one("wall_ns") / 1e9,
    pathTimeS: one("path_time_s"),
    pathScale: one("path_scale"),
    demand: four("demand"),
    demandRate: four("demand_rate"),
    measured: four("measured"),
    measuredRate: four("measured_rate"),
    solveErrorDeg: one("solve_error_deg"),
    trackingErrorDeg: one("tracking_error_deg"),
    followingErrorDeg: four("following_error_deg"),
    margin: one("margin"),
    latenessUs: one("lateness_us"),
    flags: one("flags"),
  };
}
