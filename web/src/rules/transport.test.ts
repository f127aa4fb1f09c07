import { describe, expect, it } from "vitest";
import { advance, nearest, seekOfKey } from "./transport";

const RANGE = [-0.5, 10] as const;

describe("playing", () => {
  it("follows the wall's time by its speed, and ends at the end", () => {
    expect(advance(1, 0.1, 2, RANGE)).toEqual({ at: 1.2, playing: true });
    expect(advance(9.9, 1, 1, RANGE)).toEqual({ at: 10, playing: false });
  });
});

describe("keys", () => {
  it("step, leap with Shift, and stay inside", () => {
    expect(seekOfKey("ArrowRight", false, 1, RANGE, 0.01)).toBeCloseTo(1.01, 12);
    expect(seekOfKey("ArrowLeft", true, 1, RANGE, 0.01)).toBe(0);
    expect(seekOfKey("ArrowLeft", true, 0, RANGE, 0.01)).toBe(-0.5);
    expect(seekOfKey("Home", false, 3, RANGE, 0.01)).toBe(-0.5);
    expect(seekOfKey("End", false, 3, RANGE, 0.01)).toBe(10);
  });

  it("leave Space and Esc to the rig", () => {
    expect(seekOfKey(" ", false, 1, RANGE, 0.01)).toBeNull();
    expect(seekOfKey("Escape", false, 1, RANGE, 0.01)).toBeNull();
  });
});

it("finds the nearest sample of an uneven time", () => {
  const times = [0, 0.1, 1, 1.5];
  expect([-3, 0.04, 0.06, 0.5, 0.6, 1.2, 1.26, 9].map((at) => nearest(times, at))).toEqual([0, 0, 1, 1, 2, 2, 3, 3]);
  expect(nearest([], 1)).toBe(-1);
});
