/** What a role may do. The server decides (its api/access.py); this only spares a person a refusal. */
import type { Me, Person, Role } from "../contract/types";
import type { Verdict } from "./commands";
import { PAGES, type Page } from "./router";

/** Each may all that the one before it may. */
export const ROLES: readonly Role[] = ["viewer", "operator", "admin"];

export const MEANING: Record<Role, string> = {
  viewer: "sees everything, and stops a rig",
  operator: "uploads, plans and commands",
  admin: "an operator, and says who else may use this server",
};

/** Whether a role is enough for what needs `needed`. Null: nobody signs in here, and nothing is refused. */
export function permitted(needed: Role, role: Role | null): Verdict {
  if (role === null || ROLES.indexOf(role) >= ROLES.indexOf(needed)) return { enabled: true };
  return { enabled: false, why: `Your role is ${role}` };
}

/** Of two things that are asked for the first that is not given, else that both are. */
export const both = (first: Verdict, second: Verdict): Verdict => (first.enabled ? second : first);

/** The roles that a person may give to a token. */
export const rolesUpTo = (role: Role): readonly Role[] => ROLES.slice(0, ROLES.indexOf(role) + 1);

/** The pages that are listed for who is there: people are an admin's, the account has a place of its own. */
export function pagesFor(person: Person | null): readonly Page[] {
  return PAGES.filter((page) => (page === "people" ? person?.role === "admin" : page !== "account"));
}

/** Whether the console is for who is there; else they sign in first. */
export const letIn = ({ people, person }: Me): boolean => !people || person !== null;

/** What is said to who must sign in now, and was in the console a moment ago; `was`: what was known of them then. */
export function signedOutText(was: Me | null): string | null {
  if (was === null || !letIn(was)) return null;
  const why = was.person
    ? `${was.person.name} is signed in no longer: the session has ended, or was ended.`
    : "Whoever uses this server signs in from now on.";
  return `${why} Stop and E-stop cannot be sent from here until you sign in: use the hardware E-stop.`;
}
