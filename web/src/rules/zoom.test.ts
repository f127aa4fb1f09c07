import { expect, it } from "vitest";
import { held, moved, timeText, traced, viewOfKey, zoomed } from "./zoom";

const ALL = [0, 3600] as const;

it("a moment stays where it is while the view is zoomed about it, and no view leaves what there is", () => {
  expect(zoomed([0, 3600], 900, 0.5, ALL)).toEqual([450, 2250]);
  expect(zoomed([450, 2250], 900, 2, ALL)).toEqual([0, 3600]);
  expect(zoomed([0, 100], 0, 8, ALL)).toEqual([0, 800]);
  expect(zoomed([3500, 3600], 3600, 100, ALL)).toEqual([0, 3600]);
  let view: readonly [number, number] = ALL;
  for (let k = 0; k < 60; k++) view = zoomed(view, 1800, 0.5, ALL);
  expect(view[1] - view[0]).toBeCloseTo(0.01);
  expect(view[0]).toBeLessThan(1800);
});

it("a view is moved as far as there is something", () => {
  expect(moved([100, 200], 0.5, ALL)).toEqual([150, 250]);
  expect(moved([100, 200], -5, ALL)).toEqual([0, 100]);
  expect(held([3590, 3700], ALL)).toEqual([3490, 3600]);
});

it("keys zoom about the playhead where it is in view", () => {
  expect(viewOfKey("+", [0, 100], 10, ALL)).toEqual([5, 55]);
  expect(viewOfKey("-", [100, 200], 3000, ALL)).toEqual([50, 250]);
  expect(viewOfKey("0", [100, 200], 150, ALL)).toEqual(ALL);
  expect(viewOfKey("PageDown", [100, 200], 150, ALL)).toEqual([150, 250]);
  expect(viewOfKey("x", [100, 200], 150, ALL)).toBeNull();
});

it("the line touches the extremes of every bucket, and samples are what they are", () => {
  const curve = (least: number[], greatest: number[]): { least: Float64Array; greatest: Float64Array } => ({
    least: Float64Array.from(least),
    greatest: Float64Array.from(greatest),
  });
  const points = traced(curve([0, 2], [1, 3]), curve([-5, NaN], [7, NaN]));
  expect([...points.time]).toEqual([0, 1, 2, 3]);
  expect([...points.values]).toEqual([-5, 7, NaN, NaN]);
  const one = Float64Array.from([1, 2]);
  expect(traced({ least: one, greatest: one }, { least: one, greatest: one })).toEqual({ time: one, values: one });
});

it("times are told as finely as the view needs", () => {
  expect(timeText(3723.4, 3600)).toBe("1:02:03");
  expect(timeText(123.4567, 5)).toBe("2:03.5");
  expect(timeText(59.9996, 0.5)).toBe("1:00.000");
  expect(timeText(-0.5, 0.5)).toBe("−0:00.500");
});
