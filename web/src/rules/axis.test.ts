import { expect, it } from "vitest";
import { ticksOf, tickText, type TimeAxis } from "./axis";

const texts = (axis: TimeAxis, last: number): string[] => ticksOf(axis, last, 20).map((at) => tickText(axis, at, last));

it("a rig's axis ends now while data is fresh", () => {
  expect(texts({ kind: "age", ageS: 0 }, 1234.5)).toEqual(["−20 s", "−15 s", "−10 s", "−5 s", "now"]);
});

it("a rig's axis ends at the age of its last record where that is old", () => {
  expect(texts({ kind: "age", ageS: 12 }, 1234.5)).toEqual(["−32 s", "−27 s", "−22 s", "−17 s", "−12 s"]);
  expect(texts({ kind: "age", ageS: 600 }, 0).at(-1)).toBe("−10 min");
});

it("a run's axis is the time of the run, and begins with it", () => {
  expect(texts({ kind: "run", zeroS: 1000 }, 1007.2)).toEqual(["0:00", "0:05"]);
  expect(texts({ kind: "run", zeroS: 1000 }, 1073)).toEqual(["0:55", "1:00", "1:05", "1:10"]);
});
