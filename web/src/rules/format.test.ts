import { expect, it } from "vitest";
import { bytes, clock, duration, fixed, integer, MISSING, scientific, small } from "./format";

it("fixed: a real minus, no negative zero, a dash for what is missing", () => {
  expect(fixed(-12.3456, 3)).toBe("−12.346");
  expect(fixed(-0.0001, 2)).toBe("0.00");
  expect([null, undefined, NaN, Infinity].map((value) => fixed(value, 2))).toEqual([
    MISSING,
    MISSING,
    MISSING,
    MISSING,
  ]);
});

it("scientific: an exact zero is told from a missing value", () => {
  expect(scientific(3.24e-13)).toBe("3.2e−13");
  expect([12, 81, -0.5, 1234, 1e5, -2e-7].map((each) => scientific(each))).toEqual([
    "12.00",
    "81.00",
    "−0.5000",
    "1234",
    "1.0e5",
    "−2.0e−7",
  ]);
  expect(scientific(0)).toBe("0");
  expect(scientific(NaN)).toBe(MISSING);
});

it("small changes its notation at a thousandth", () => {
  expect([0.08312, 0.001, 0.00099, 5.5e-5, 0].map(small)).toEqual(["0.0831", "0.0010", "9.9e−4", "5.5e−5", "0"]);
  expect([NaN, null, undefined].map(small)).toEqual([MISSING, MISSING, MISSING]);
});

it("duration picks its unit", () => {
  expect([0.25, 3.14, 42.4, 1500, 61_000, 150_000].map(duration)).toEqual([
    "250 µs",
    "3.1 ms",
    "42 ms",
    "1.50 s",
    "61.0 s",
    "3 min",
  ]);
  expect(duration(null)).toBe(MISSING);
});

it("clock counts minutes and goes negative in the lead-in", () => {
  expect([0, 3.214, 75.5, 59.999, -0.8].map(clock)).toEqual(["0:00.00", "0:03.21", "1:15.50", "0:59.99", "−0:00.80"]);
  expect(clock(NaN)).toBe(MISSING);
});

it("bytes and integers", () => {
  expect([12, 1234, 78_100, 4_812_332, 93e9].map(bytes)).toEqual(["12 B", "1.2 kB", "78 kB", "4.8 MB", "93.0 GB"]);
  expect(integer(14001)).toBe("14,001");
  expect(integer(null)).toBe(MISSING);
});
