/** Lines of the audit as people read them: commands of rigs, and what was done about people, flights, plans, records. */
import type { AuditLine } from "../contract/types";
import { inWords, MISSING } from "./format";

export interface AuditLook {
  rig: string;
  command: string;
  /** What it was about, where the line is no rig's. */
  about: string;
  /** The state it led to; a rig's alone has one. */
  state: string;
  refused: string;
}

export function auditLook(line: AuditLine): AuditLook {
  const { rig, command, args, state_after: after } = line;
  return {
    rig: rig ?? MISSING,
    command: after === null ? command : inWords(command), // of no session: a method and a path
    about: after === null ? aboutOf(args) : "",
    state: stateOf(line),
    refused: line.accepted ? "" : (line.detail ?? "refused"),
  };
}

function stateOf({
  state_before: before,
  state_after: after,
}: Pick<AuditLine, "state_before" | "state_after">): string {
  if (before === null || after === null || before === after) return after ?? before ?? MISSING;
  return `${before} → ${after}`;
}

/** What it says it is about, else what it names. */
function aboutOf(args: AuditLine["args"]): string {
  if (typeof args["about"] === "string") return args["about"];
  const named = Object.entries(args).filter(([key, value]) => key !== "from" && typeof value === "string");
  return named.map(([key, value]) => `${key} ${String(value)}`).join(", ");
}
