/** Requests typed by the generated contract: a path, parameter or body that it does not know does not compile. */
import type { paths, sockets } from "../contract/schema";
import { ApiError, refusal, silence } from "./errors";
import { CLIENT_HEADER, me } from "./identity";

type Verb = "get" | "post" | "delete";
type Successes = 200 | 201 | 202 | 204;

/** The paths that have this verb. */
type PathOf<V extends Verb> = {
  [Path in keyof paths]: paths[Path] extends Record<V, { responses: unknown }> ? Path : never;
}[keyof paths];
type JsonOf<T> = T extends { content: { "application/json": infer Json } } ? Json : undefined;
type Answers<R> = { [Status in keyof R & Successes]: JsonOf<R[Status]> }[keyof R & Successes];
type AnswerOf<Path extends keyof paths, V extends Verb> = paths[Path][V] extends { responses: infer R }
  ? Answers<R>
  : never;
type BodyOf<Path extends keyof paths, V extends Verb> = paths[Path][V] extends { requestBody?: infer B }
  ? JsonOf<B>
  : undefined;
type QueryOf<Path> = Path extends keyof paths
  ? paths[Path]["get"] extends { parameters: { query?: infer Query } }
    ? Query
    : undefined
  : undefined;

/** What a path names in braces. */
type Named<Path extends string> = Path extends `${string}{${infer Name}}${infer Rest}`
  ? Record<Name, string> & Named<Rest>
  : unknown;

/** A path of the contract, filled in. */
export function pathTo<Path extends keyof (paths & sockets)>(
  path: Path,
  named: Named<Path>,
  query?: QueryOf<Path>,
): string {
  const values = named as Record<string, string>;
  const filled = path.replace(/\{(\w+)\}/g, (_, name: string) => encodeURIComponent(values[name] ?? ""));
  const asked = new URLSearchParams(Object.entries(query ?? {}).map(([key, value]) => [key, String(value)]));
  return asked.size > 0 ? `${filled}?${asked}` : filled;
}

/** A WebSocket of the contract, at the server this page is from. */
export function socketTo<Path extends keyof sockets>(path: Path, named: Named<Path>): string {
  const scheme = location.protocol === "https:" ? "wss:" : "ws:";
  return `${scheme}//${location.host}${pathTo(path, named)}`;
}

interface Sending<Body, Query> {
  query?: Query;
  body?: Body;
  /** How long the answer may take [ms]. */
  withinMs: number;
  /** Sent also from a page that is being left. */
  keepalive?: boolean;
}

/** What a request is answered with. Raises `ApiError` for a refusal, and where no answer comes in time. */
export async function request<V extends Verb, Path extends PathOf<V>>(
  verb: V,
  path: Path,
  named: Named<Path>,
  sending: Sending<BodyOf<Path, V>, QueryOf<Path>>,
): Promise<AnswerOf<Path, V>> {
  const { body, withinMs, keepalive = false }: Sending<unknown, unknown> = sending;
  const headers: Record<string, string> = { [CLIENT_HEADER]: me() };
  const init: RequestInit = { method: verb.toUpperCase(), keepalive, headers, signal: AbortSignal.timeout(withinMs) };
  if (body !== undefined) {
    init.body = JSON.stringify(body);
    headers["content-type"] = "application/json";
  }
  let response: Response;
  let text: string;
  try {
    response = await fetch(pathTo(path, named, sending.query), init);
    text = await response.text();
  } catch (error) {
    if (error instanceof DOMException && error.name === "TimeoutError") {
      throw new ApiError(0, `The server did not answer within ${withinMs / 1000} s`);
    }
    throw silence();
  }
  if (!response.ok) throw refusal(response.status, text);
  return (text === "" ? undefined : JSON.parse(text)) as AnswerOf<Path, V>;
}
