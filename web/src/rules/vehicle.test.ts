import { expect, it } from "vitest";
import { axesSeen, seen, turned, vehicleSeen, type Vector } from "./vehicle";

const near = (a: Vector, b: Vector): void => a.forEach((each, k) => expect(each).toBeCloseTo(b[k] ?? NaN, 12));

it("turns about each axis by the right hand", () => {
  const half = Math.SQRT1_2;
  near(turned([half, half, 0, 0], [0, 1, 0]), [0, 0, 1]);
  near(turned([half, 0, half, 0], [0, 0, 1]), [1, 0, 0]);
  near(turned([half, 0, 0, half], [1, 0, 0]), [0, 1, 0]);
});

it("has up above, east to the right, north away", () => {
  expect(seen([0, 1, 0]).at[1]).toBeLessThan(0);
  expect(seen([0, 0, 1]).at[0]).toBeGreaterThan(0);
  expect(seen([1, 0, 0]).depth).toBeGreaterThan(0);
});

it("draws the same directions whatever the convention calls them", () => {
  const at = (convention: "ned" | "enu" | "nue", name: string): readonly number[] =>
    axesSeen(convention, null).find((axis) => axis.name === name)?.at ?? [];
  expect(at("ned", "North")).toEqual(at("enu", "North"));
  const [x, y] = at("nue", "Up") as [number, number];
  const [down, below] = at("ned", "Down") as [number, number];
  expect(down + x).toBeCloseTo(0, 12);
  expect(below + y).toBeCloseTo(0, 12);
  expect(axesSeen("ned", [1, 0, 0, 0])[0]?.at).toEqual(at("ned", "North"));
});

it("draws what is farther away first", () => {
  expect(
    vehicleSeen([1, 0, 0, 0])
      .map(({ name }) => name)
      .sort(),
  ).toEqual(["fin", "hull", "tail", "wing"]);
});
