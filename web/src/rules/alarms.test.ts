import { expect, it } from "vitest";
import type { Alarm } from "../contract/types";
import { causeOf, newestFirst } from "./alarms";
import { clockTime } from "./format";

function alarm(given: Partial<Alarm>): Alarm {
  return {
    number: 1,
    shelved: false,
    code: "rate_limit",
    severity: "fault",
    message: "",
    first: false,
    count: 1,
    time_s: 0,
    ...given,
  };
}

it("a trip says its frame, its value and the limit", () => {
  const trip = alarm({ first: true, frame: "inner", value: 512.5, limit: 500, unit: "deg/s" });
  expect(causeOf(trip)).toBe("first cause, rate limit, inner: 512.500 past 500.000 deg/s");
});

it("what has no value says what it is, and how often it came", () => {
  expect(causeOf(alarm({ code: "link_lost" }))).toBe("link lost");
  expect(causeOf(alarm({ code: "link_lost", count: 3 }))).toBe(`link lost (3 times since ${clockTime(0)})`);
  expect(causeOf(alarm({ value: 2, limit: null, unit: null }))).toBe("rate limit: 2.000");
});

it("are read by when they came last, of one time by number", () => {
  const alarms = [
    alarm({ number: 1, time_s: 5 }),
    alarm({ number: 2, time_s: 1, last_time_s: 9 }),
    alarm({ number: 3, time_s: 5 }),
  ];
  expect(alarms.sort(newestFirst).map(({ number }) => number)).toEqual([2, 3, 1]);
});
