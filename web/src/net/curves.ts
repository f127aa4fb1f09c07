/** Windows of a run's curves: least and greatest values by bucket, from the server's binary form. */
import { FrameError } from "./telemetry";

export interface Curve {
  readonly least: Float64Array;
  /** The same array where every bucket is one sample. */
  readonly greatest: Float64Array;
}

export interface CurvesWindow {
  readonly buckets: number;
  readonly columns: ReadonlyMap<string, Curve>;
}

const MAGIC = 0x31435046; // "FPC1", little-endian
const HEADER_BYTES = 16;

/** Header {magic u4, columns u4, buckets u4, samples u4}, then f8: of each column the least values, then the greatest. */
export function decodeCurves(buffer: ArrayBuffer, names: readonly string[]): CurvesWindow {
  if (buffer.byteLength < HEADER_BYTES) throw new FrameError(`curves of ${buffer.byteLength} bytes have no header`);
  const header = new DataView(buffer);
  if (header.getUint32(0, true) !== MAGIC) throw new FrameError("no curves");
  const count = header.getUint32(4, true);
  const buckets = header.getUint32(8, true);
  const parts = header.getUint32(12, true) === 1 ? 1 : 2;
  if (count !== names.length || buffer.byteLength !== HEADER_BYTES + 8 * count * parts * buckets)
    throw new FrameError(`${buffer.byteLength} bytes do not hold ${buckets} buckets of ${names.length} columns`);
  const values = new Float64Array(buffer, HEADER_BYTES); // every machine that runs a browser is little-endian
  const part = (at: number): Float64Array => values.subarray(at * buckets, (at + 1) * buckets);
  const columns = new Map(
    names.map((name, k): [string, Curve] => {
      const least = part(k * parts);
      return [name, { least, greatest: parts === 1 ? least : part(2 * k + 1) }];
    }),
  );
  return { buckets, columns };
}
