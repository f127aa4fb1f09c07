import { expect, it } from "vitest";
import contract from "../../../docs/openapi.json";
import { settled, unconfirmedText } from "./stopping";

const STATES = contract.components.schemas.State.enum;

it("a stop is settled where the rig brakes or is past it", () => {
  expect(STATES.filter((state) => !settled("stop", state)).sort()).toEqual(["held", "live", "positioning", "running"]);
});

it("an E-stop is settled by the latch alone, or where there is no drive", () => {
  expect(STATES.filter((state) => settled("estop", state)).sort()).toEqual(["disconnected", "estopped"]);
});

it("says what was not confirmed, why, and what is left", () => {
  expect(unconfirmedText("estop", "No answer within 2 s")).toBe(
    "E-stop not confirmed: No answer within 2 s. If the rig moves, use the hardware E-stop.",
  );
});
