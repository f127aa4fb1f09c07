import { describe, expect, it } from "vitest";
import contract from "../../../docs/openapi.json";
import type { Plan } from "../contract/types";
import { foundOf, kindOf, remediable, remediesOf, REMEDIES } from "./remedies";

function plan(fields: object): Plan {
  return {
    id: "a",
    status: "done",
    flyable: false,
    error: null,
    remedy: null,
    report: { feasible: false },
    ...fields,
  } as unknown as Plan;
}
const remedy = (fields: object = {}): object => ({
  of: "a",
  sufficient: true,
  change: { statement: "flown 1.2 times as slow" },
  ...fields,
});

it("offers every kind the server knows", () => {
  expect(REMEDIES.map(({ kind }) => kind)).toEqual(contract.components.schemas.RemedyIn.properties.kind.enum);
  expect(kindOf("relax")).toBe("Raise one limit");
});

it("is offered to a flight that does not fit, and not to a remedy of it", () => {
  expect(remediable(plan({}))).toBe(true);
  expect(remediable(plan({ status: "running", report: null }))).toBe(false);
  expect(remediable(plan({ report: { feasible: true } }))).toBe(false);
  expect(remediable(plan({ remedy: remedy({ sufficient: false }) }))).toBe(false);
});

it("finds the searches of a plan", () => {
  const all = [plan({ id: "c", remedy: remedy() }), plan({ id: "b", remedy: remedy({ of: "x" }) }), plan({})];
  expect(remediesOf(all, "a").map(({ id }) => id)).toEqual(["c"]);
});

describe("what a search came to", () => {
  it("says what was changed", () => {
    expect(foundOf(plan({ flyable: true, remedy: remedy() }))).toEqual({
      tone: "good",
      word: "Fits",
      detail: "flown 1.2 times as slow",
    });
  });
  it("tells what fits from what can be flown", () => {
    expect(foundOf(plan({ remedy: remedy() }))).toMatchObject({ tone: "caution", word: "Fits, not flyable yet" });
  });
  it("does not hide that it is not enough", () => {
    expect(foundOf(plan({ remedy: remedy({ sufficient: false }) }))).toMatchObject({
      tone: "danger",
      word: "Not enough",
    });
    const failed = plan({
      status: "failed",
      error: { code: "no-remedy", message: "no single limit" },
      remedy: remedy({ change: null }),
    });
    expect(foundOf(failed)).toMatchObject({ tone: "danger", detail: "no single limit" });
  });
});
