/** Requests typed by the generated contract: a path, parameter or body that it does not know does not compile. */
import type { paths, sockets } from "../contract/schema";
import { ApiError, refusal, silence } from "./errors";
import { CLIENT_HEADER, me } from "./identity";

type Verb = "get" | "post" | "put" | "patch" | "delete";
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
type RowOf<Rows> = Rows extends readonly (infer Row)[] ? Row : never;
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
  // What is null is not asked for.
  const given = Object.entries(query ?? {}).filter(([, value]) => value !== null && value !== undefined);
  const asked = new URLSearchParams(given.map(([key, value]) => [key, String(value)]));
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
  const { text } = await sent(verb, pathTo(path, named, sending.query), sending);
  return (text === "" ? undefined : JSON.parse(text)) as AnswerOf<Path, V>;
}

/** A part of a list, the newest rows first. */
export interface Page<Row> {
  readonly rows: readonly Row[];
  /** Where the next page begins; null where there is none. */
  readonly next: string | null;
}

/** A page of a list, the rows after `before`, and where the next one begins. Raises as `request` does. */
export async function page<Path extends PathOf<"get">>(
  path: Path,
  named: Named<Path>,
  wanted: Omit<NonNullable<QueryOf<Path>>, "before" | "limit">,
  before: string | null,
  withinMs: number,
): Promise<Page<RowOf<AnswerOf<Path, "get">>>> {
  const query = { ...wanted, before } as QueryOf<Path>;
  const { text, link } = await sent("get", pathTo(path, named, query), { withinMs });
  return { rows: JSON.parse(text) as RowOf<AnswerOf<Path, "get">>[], next: cursorOf(link) };
}

/** Where the next page begins, of a `Link` header (RFC 8288). */
export function cursorOf(link: string | null): string | null {
  const next = /<([^>]*)>;\s*rel="next"/.exec(link ?? "")?.[1];
  return next === undefined ? null : new URLSearchParams(next.split("?")[1]).get("before");
}

/** The bytes of an answer that is no JSON. Raises as `request` does. */
export async function bytes<Path extends PathOf<"get">>(
  path: Path,
  named: Named<Path>,
  query: QueryOf<Path>,
  withinMs: number,
): Promise<ArrayBuffer> {
  return (await sent("get", pathTo(path, named, query), { withinMs })).buffer;
}

interface Sent {
  readonly text: string;
  readonly buffer: ArrayBuffer;
  readonly link: string | null;
}

async function sent(
  verb: Verb,
  url: string,
  { body, withinMs, keepalive = false }: Omit<Sending<unknown, unknown>, "query">,
): Promise<Sent> {
  const headers: Record<string, string> = { [CLIENT_HEADER]: me() };
  const init: RequestInit = { method: verb.toUpperCase(), keepalive, headers, signal: AbortSignal.timeout(withinMs) };
  if (body !== undefined) {
    init.body = JSON.stringify(body);
    headers["content-type"] = "application/json";
  }
  let response: Response;
  let buffer: ArrayBuffer;
  try {
    response = await fetch(url, init);
    buffer = await response.arrayBuffer();
  } catch (error) {
    if (error instanceof DOMException && error.name === "TimeoutError") {
      throw new ApiError(0, `The server did not answer within ${withinMs / 1000} s`);
    }
    throw silence();
  }
  const read = (): string => new TextDecoder().decode(buffer);
  if (!response.ok) throw refusal(response.status, read());
  return {
    buffer,
    link: response.headers.get("link"),
    get text(): string {
      return read();
    },
  };
}
