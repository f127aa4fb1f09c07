import { expect, it } from "vitest";
import type { AuditLine } from "../contract/types";
import { auditLook } from "./audit";

const line = (given: Partial<AuditLine>): AuditLine => ({
  id: 1,
  at: "2026-11-29T10:00:00Z",
  who: "ann",
  address: null,
  previous: "0",
  hash: "1",
  rig: "bench",
  command: "go_live",
  args: { from: "not of people" },
  lease_epoch: null,
  lease_sequence: null,
  state_before: "armed",
  state_after: "live",
  accepted: true,
  detail: null,
  ...given,
});

it("a command is told with the states before and after it, and why it was refused", () => {
  expect(auditLook(line({}))).toEqual({
    rig: "bench",
    command: "go live",
    about: "",
    state: "armed → live",
    refused: "",
  });
  expect(auditLook(line({ state_after: "armed", accepted: false, detail: "no source" }))).toMatchObject({
    state: "armed",
    refused: "no source",
  });
  expect(auditLook(line({ accepted: false })).refused).toBe("refused");
});

it("what is of no session has no rig and no state, but what it was about", () => {
  const none = { rig: null, state_before: null, state_after: null };
  const change = line({ ...none, command: "user change", args: { from: "10.0.0.2", about: "bob: role viewer" } });
  expect(auditLook(change)).toEqual({
    rig: "–",
    command: "user change",
    about: "bob: role viewer",
    state: "–",
    refused: "",
  });
  expect(auditLook(line({ ...none, command: "login", args: {} })).about).toBe("");
  const made = line({ ...none, command: "POST /plans/{plan}/remedies", args: { plan: "a", made: "/plans/b" } });
  expect(auditLook(made)).toMatchObject({ command: "POST /plans/{plan}/remedies", about: "plan a, made /plans/b" });
});
