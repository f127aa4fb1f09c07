import { expect, it } from "vitest";
import { decodeCurves } from "./curves";
import { FrameError } from "./telemetry";

function frame(columns: number, buckets: number, samples: boolean, values: number[]): ArrayBuffer {
  const view = new DataView(new ArrayBuffer(16 + 8 * values.length));
  [0x31435046, columns, buckets, samples ? 1 : 0].forEach((word, k) => view.setUint32(4 * k, word, true));
  values.forEach((value, k) => view.setFloat64(16 + 8 * k, value, true));
  return view.buffer;
}

it("buckets have least and greatest by column, samples have one value", () => {
  const window = decodeCurves(frame(2, 2, false, [0, 1, 0.5, 1.5, -3, NaN, 4, NaN]), ["time_s", "x"]);
  expect([...(window.columns.get("x")?.least ?? [])]).toEqual([-3, NaN]);
  expect([...(window.columns.get("x")?.greatest ?? [])]).toEqual([4, NaN]);
  const samples = decodeCurves(frame(1, 3, true, [1, 2, 3]), ["time_s"]).columns.get("time_s");
  expect(samples?.least).toEqual(samples?.greatest);
});

it("what is cut off or of other columns is refused", () => {
  const whole = frame(1, 2, true, [1, 2]);
  expect(() => decodeCurves(whole.slice(0, 20), ["time_s"])).toThrow(FrameError);
  expect(() => decodeCurves(whole.slice(0, 3), ["time_s"])).toThrow(FrameError);
  expect(() => decodeCurves(whole, ["time_s", "x"])).toThrow(FrameError);
  expect(() => decodeCurves(new ArrayBuffer(32), ["time_s"])).toThrow(FrameError);
});
