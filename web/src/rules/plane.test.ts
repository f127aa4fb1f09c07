import { expect, it } from "vitest";
import type { Plane } from "../contract/types";
import { cellSentence, limitOf, onScale, pathSentence, PlaneCells, shade } from "./plane";

const text = (bytes: number[]): string => btoa(String.fromCharCode(...bytes.map((value) => value & 255)));

/** Two times, three base angles; the plan is on the second side at the second time. */
const PLANE: Plane = {
  time_s: [0, 1],
  base_deg: [-90, 90],
  rows: 3,
  margin: text([1, 2, 3, 4, 5, 6, 10, -20, 30, -40, 50, 60]),
  limits: text([5, 5, 5, 5, 5, 5, 5, 5, 5, 5 + 16 * 8, 0, 1]),
  needles: [],
  needles_left_out: 0,
  path: { base_deg: [0, 10], side: [0, 1], margin: [4, -2], limit: [5, 12] },
  tightest: { time_s: 1, margin: -2, frame: "inner", limit: "acceleration", sentence: "Tightest at 1.000 s." },
};
const cells = new PlaneCells(PLANE);

it("a cell is that of the plan's side, or of the better one", () => {
  expect(cells.at(0, 1, "flown").margin).toBe(2);
  expect(cells.at(1, 2, "flown")).toEqual({ margin: 60, binding: 1, against: 0 });
  expect(cells.at(0, 0, "best").margin).toBe(10);
  expect(cells.at(0, 1, "best").margin).toBe(2);
  expect(cells.at(1, 0, "flown")).toEqual({ margin: -40, binding: 5, against: 8 });
});

it("a base angle has a row, also beyond the plane", () => {
  expect([-500, -90, -46, -44, 40, 90, 500].map((deg) => cells.row(deg))).toEqual([0, 0, 0, 1, 1, 2, 2]);
});

it("a cell and the plan are told in words", () => {
  expect([limitOf(1), limitOf(5), limitOf(12), limitOf(13), limitOf(16), limitOf(0)]).toEqual([
    "the base frame's position limit",
    "the outer frame's rate limit",
    "the inner frame's acceleration limit",
    "the base frame's jerk limit",
    "the inner frame's jerk limit",
    "no limit",
  ]);
  expect(cellSentence(cells.at(0, 1, "flown"), 0.25, -12)).toBe(
    "At 0.250 s with the base at −12.0 deg a path can leave 2 % at most: the outer frame's rate limit.",
  );
  expect(cellSentence(cells.at(1, 0, "flown"), 1, 0)).toBe(
    "At 1.000 s with the base at 0.0 deg no path passes: the outer frame's rate limit against the middle frame's rate limit.",
  );
  expect(cellSentence(cells.at(1, 1, "flown"), 1, 0)).toContain("no limit is asked for anything");
  expect(pathSentence(PLANE, 0)).toBe("The plan leaves 4 % of the outer frame's rate limit about then.");
  expect(pathSentence(PLANE, 1)).toBe("The plan goes beyond the inner frame's acceleration limit about then.");
});

it("colours become lighter with the margin, for every eye", () => {
  const light = ([r, g, b]: number[]): number => 0.2126 * (r ?? 0) + 0.7152 * (g ?? 0) + 0.0722 * (b ?? 0);
  const lights = Array.from({ length: 101 }, (_, margin) => light(shade(margin)));
  expect(lights.every((value, i) => i === 0 || value >= (lights[i - 1] ?? 0))).toBe(true);
  expect(shade(0)).toEqual([0x44, 0x01, 0x54]);
  expect(shade(100)).toEqual([0xfd, 0xe7, 0x25]);
  expect([onScale(0), onScale(25), onScale(100), onScale(-7)]).toEqual([0, 0.5, 1, 0]);
});
