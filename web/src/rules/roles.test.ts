import { expect, it } from "vitest";
import type { Me, Role } from "../contract/types";
import { both, letIn, pagesFor, permitted, rolesUpTo, ROLES, signedOutText } from "./roles";

const person = (role: Role) => ({ name: "ann", role, via: "session" as const, until: null });
const me = (given: Partial<Me>): Me => ({ people: true, person: null, provider: null, ...given });

it("each role may what those before it may, and nobody is refused where nobody signs in", () => {
  const may = (needed: Role, role: Role | null): boolean => permitted(needed, role).enabled;
  expect(ROLES.map((role) => [may("viewer", role), may("operator", role), may("admin", role)])).toEqual([
    [true, false, false],
    [true, true, false],
    [true, true, true],
  ]);
  expect(may("admin", null)).toBe(true);
  expect(permitted("operator", "viewer")).toEqual({ enabled: false, why: "Your role is viewer" });
  expect(may("operator", "auditor" as Role)).toBe(false); // of a newer server
});

it("of two refusals the first is said", () => {
  const [yes, no, pinned] = [{ enabled: true }, { enabled: false, why: "a" }, { enabled: false, why: "b" }] as const;
  expect([both(yes, yes), both(no, pinned), both(yes, pinned), both(no, yes)]).toEqual([yes, no, pinned, no]);
});

it("a token has at most its person's role", () => {
  expect(ROLES.map(rolesUpTo)).toEqual([["viewer"], ["viewer", "operator"], ["viewer", "operator", "admin"]]);
});

it("people are on an admin's rail alone, the account on nobody's", () => {
  for (const who of [null, person("viewer"), person("operator")]) expect(pagesFor(who)).not.toContain("people");
  expect(pagesFor(person("admin"))).toContain("people");
  expect(pagesFor(person("admin"))).not.toContain("account");
});

it("who was in is told why they no longer are, who only comes is told nothing", () => {
  expect([me({}), me({ person: person("viewer") }), me({ people: false })].map(letIn)).toEqual([false, true, true]);
  expect([null, me({})].map(signedOutText)).toEqual([null, null]);
  expect(signedOutText(me({ person: person("viewer") }))).toContain("ann is signed in no longer");
  expect(signedOutText(me({ people: false }))).toContain("signs in from now on");
  expect(signedOutText(me({ people: false }))).toContain("use the hardware E-stop");
});
