// @vitest-environment happy-dom
import { expect, it } from "vitest";
import { draftOf, mapOf, remember, remembered, rolesOf } from "./reading";

const NAMES = ["t", "a", "b", "c", "d"];

it("begins from what was taken, and gives it back", () => {
  const columns = {
    axes: "enu" as const,
    time: { column: "t", unit: "ms" as const, epoch: "first" as const },
    euler: null,
    quaternion: {
      columns: ["d", "a", "b", "c"] as [string, string, string, string],
      sense: "reference_to_body" as const,
    },
  };
  expect(mapOf(draftOf({ names: NAMES, columns }))).toEqual(columns);
});

it("begins from the first columns where nothing was taken", () => {
  const draft = draftOf({ names: NAMES, columns: null });
  expect([draft.time, ...draft.columns]).toEqual(["t", "a", "b", "c"]);
  expect(mapOf(draft)?.euler).toEqual({ columns: ["a", "b", "c"], order: "ZYX", unit: "deg" });
});

it("is no map while a column stands for two things or is missing", () => {
  const draft = draftOf({ names: NAMES, columns: null });
  expect(mapOf({ ...draft, columns: ["a", "a", "b"] })).toBeNull();
  expect(mapOf({ ...draft, kind: "quaternion" })).toBeNull();
});

it("names the axes of the turns", () => {
  expect(rolesOf({ kind: "euler", order: "YZX" })[0]).toBe("First angle, about y");
  expect(rolesOf({ kind: "quaternion", order: "ZYX" })).toEqual(["w", "x", "y", "z"]);
});

it("remembers by the columns of a file", () => {
  localStorage.clear();
  remember(NAMES, { profile: "ours", bridge_gaps: true });
  expect(remembered(NAMES)).toEqual({ profile: "ours" });
  expect(remembered(["t"])).toBeNull();
  localStorage.setItem("fullpose.reading", "damaged");
  expect(remembered(NAMES)).toBeNull();
});
