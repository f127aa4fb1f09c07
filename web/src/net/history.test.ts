import { expect, it } from "vitest";
import { CHANNEL, History } from "./history";
import type { Sample } from "./telemetry";

function sample(timeS: number): Sample {
  return {
    seq: timeS,
    timeS,
    wallS: 0,
    pathTimeS: 0,
    pathScale: 1,
    demand: [0, 0, 0, -timeS],
    demandRate: [0, 0, 0, 0],
    measured: [timeS, 10 * timeS, 0, 0],
    measuredRate: [0, 0, 0, 0],
    solveErrorDeg: 1e-14,
    trackingErrorDeg: NaN,
    followingErrorDeg: [0, 0, 0, 0],
    margin: 1,
    latenessUs: 0,
    flags: 0,
  };
}

it("keeps the newest samples in order, through many turns of its memory", () => {
  const history = new History(5);
  for (let t = 1; t <= 23; t++) {
    history.push(sample(t));
    const first = Math.max(1, t - 4);
    const expected = Array.from({ length: t - first + 1 }, (_, i) => first + i);
    expect([...history.time()]).toEqual(expected);
    expect([...history.channel(CHANNEL.measured + 1)]).toEqual(expected.map((value) => 10 * value));
    expect([...history.channel(CHANNEL.demand + 3)]).toEqual(expected.map((value) => -value));
  }
  expect([...history.channel(CHANNEL.trackingError)].every(Number.isNaN)).toBe(true);
});

it("begins anew where time goes backward, as after a new rig process", () => {
  const history = new History(5);
  history.push(sample(100));
  history.push(sample(101));
  history.push(sample(3));
  expect([...history.time()]).toEqual([3]);
});

it("keeps what is before the time a replay is set back to", () => {
  const history = new History(5);
  for (const time of [1, 2, 3, 4]) history.push(sample(time));
  history.push(sample(2.5));
  expect([...history.time()]).toEqual([1, 2, 2.5]);
  expect([...history.channel(CHANNEL.measured)]).toEqual([1, 2, 2.5]);
});

it("does not join what is after a break", () => {
  const history = new History(5);
  history.break();
  for (const time of [1, 2]) history.push(sample(time));
  history.break();
  history.push(sample(9));
  expect([...history.channel(CHANNEL.measured)]).toEqual([1, 2, NaN, 9]);
  expect([...history.time()]).toEqual([1, 2, 2.000001, 9]);
});

it("has no channel beyond its last", () => {
  expect(() => new History(2).channel(18)).toThrow(RangeError);
});
