/** Refusals of the server, and answers that did not come. */
import type { Problem } from "../contract/types";

/** A refusal of the server, or no answer at all (status 0). */
export class ApiError extends Error {
  override name = "ApiError";
  constructor(
    readonly status: number,
    message: string,
    /** What is wrong with the request, where the server says so. */
    readonly errors: Problem["errors"] = [],
    /** What the server calls it, the end of the problem's type: "sign-in", "role". */
    readonly kind: string = "",
  ) {
    super(message);
  }
}

/** What a person reads of an error: the detail, and where in the file or the request it is. */
export function messageOf(error: unknown): string {
  if (!(error instanceof ApiError)) return error instanceof Error ? error.message : String(error);
  const first = error.errors[0];
  if (!first || error.message.includes(first.message)) return error.message;
  const line = first.line ? `line ${first.line}, ` : "";
  return `${error.message} (${line}${first.where}: ${first.message})`;
}

/** What a refused request says: its problem document. A proxy's page is none: the status is all there is to say. */
export function refusal(status: number, body: string): ApiError {
  try {
    const problem = JSON.parse(body) as Partial<Problem> | null;
    if (typeof problem?.detail === "string") return problemOf(status, problem.detail, problem);
  } catch {
    // not JSON
  }
  return new ApiError(status, `The server answered ${status}`);
}

/** A problem document as an error. */
export function problemOf(status: number, detail: string, { type, errors }: Partial<Problem>): ApiError {
  return new ApiError(status, detail, errors ?? [], type?.split(":").at(-1) ?? "");
}

export function silence(): ApiError {
  return new ApiError(0, "The server does not answer");
}
