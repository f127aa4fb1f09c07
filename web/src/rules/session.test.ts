import { expect, it } from "vitest";
import contract from "../../../docs/openapi.json";
import { ASIDE, lookOf, PATH } from "./session";

it("draws exactly the states of the contract", () => {
  const drawn = [...PATH, ...ASIDE].map(({ name }) => name);
  expect([...drawn].sort()).toEqual([...contract.components.schemas.State.enum].sort());
  expect(new Set(drawn).size).toBe(drawn.length);
});

it("shows a state it does not know by its name", () => {
  expect(lookOf("homing")).toMatchObject({ label: "homing", tone: "quiet" });
});
