/** The REST API: one function a request, typed by the generated contract. */
import type {
  CommandOut,
  Comparison,
  Health,
  Lease,
  LeaseAction,
  LeaseToken,
  Method,
  Plan,
  PlanIn,
  PlanSamples,
  Problem,
  RemedyKind,
  Rig,
  Run,
  ScenePose,
  Trajectory,
  TrajectoryPreview,
} from "../contract/types";

const BASE = "/api/v1";

/** The name this tab commands under while the server knows no users: the lease is one tab's, not one machine's. */
export function me(): string {
  let name = sessionStorage.getItem("fullpose.me");
  if (name === null) {
    name = `console-${(crypto.getRandomValues(new Uint32Array(1))[0] ?? 0).toString(36).slice(0, 4)}`;
    sessionStorage.setItem("fullpose.me", name);
  }
  return name;
}

/** A refusal of the server, or no answer at all (status 0). */
export class ApiError extends Error {
  override name = "ApiError";
  constructor(
    readonly status: number,
    message: string,
    readonly problem: Problem | null = null,
  ) {
    super(message);
  }
}

/** What a person reads of an error: the detail, and where in the file or the request it is. */
export function messageOf(error: unknown): string {
  if (!(error instanceof ApiError)) return error instanceof Error ? error.message : String(error);
  const first = error.problem?.errors[0];
  if (!first || error.message.includes(first.message)) return error.message;
  const line = first.line ? `line ${first.line}, ` : "";
  return `${error.message} (${line}${first.where}: ${first.message})`;
}

function failure(status: number, body: string): ApiError {
  try {
    const problem = JSON.parse(body) as Problem;
    if (typeof problem.detail === "string") return new ApiError(status, problem.detail, problem);
  } catch {
    // Not a problem document: a proxy's page, or nothing. The status is all there is to say.
  }
  return new ApiError(status, status === 0 ? "The server does not answer" : `The server answered ${status}`);
}

/** How long an answer may take [ms]: to a Stop, to a command or the lease, and to what is read or begun. */
const STOP_MS = 2000;
const COMMAND_MS = 10_000;
const READ_MS = 60_000;

interface Sending {
  body?: unknown;
  withinMs?: number;
  /** Sent also from a page that is being left. */
  keepalive?: boolean;
}

async function request<T>(
  method: string,
  path: string,
  { body, withinMs = READ_MS, keepalive = false }: Sending = {},
): Promise<T> {
  const headers: Record<string, string> = { "x-fullpose-client": me() };
  const init: RequestInit = { method, keepalive, headers, signal: AbortSignal.timeout(withinMs) };
  if (body !== undefined) {
    init.body = JSON.stringify(body);
    headers["content-type"] = "application/json";
  }
  let response: Response;
  let text: string;
  try {
    response = await fetch(BASE + path, init);
    text = await response.text();
  } catch (error) {
    if (error instanceof DOMException && error.name === "TimeoutError") {
      throw new ApiError(0, `The server did not answer within ${withinMs / 1000} s`);
    }
    throw failure(0, "");
  }
  if (!response.ok) throw failure(response.status, text);
  return (text === "" ? undefined : JSON.parse(text)) as T;
}

const at = encodeURIComponent;

function webSocket(path: string): string {
  const scheme = location.protocol === "https:" ? "wss:" : "ws:";
  return `${scheme}//${location.host}${BASE}${path}`;
}

export const api = {
  health: () => request<Health>("GET", "/health"),
  rigs: () => request<Rig[]>("GET", "/rigs"),
  methods: () => request<Method[]>("GET", "/methods"),

  trajectories: () => request<Trajectory[]>("GET", "/trajectories"),
  preview: (sha: string, points = 800) =>
    request<TrajectoryPreview>("GET", `/trajectories/${at(sha)}/preview?points=${points}`),
  deleteTrajectory: (sha: string) => request<undefined>("DELETE", `/trajectories/${at(sha)}`),

  plans: () => request<Plan[]>("GET", "/plans"),
  plan: (id: string) => request<Plan>("GET", `/plans/${at(id)}`),
  planSamples: (id: string, points = 1200) => request<PlanSamples>("GET", `/plans/${at(id)}/samples?points=${points}`),
  createPlan: (trajectory: string, rig: string, method: string) =>
    request<Plan>("POST", "/plans", {
      body: { trajectory, rig, method } satisfies Pick<PlanIn, "trajectory" | "rig" | "method">,
    }),
  createRemedy: (plan: string, kind: RemedyKind) =>
    request<Plan>("POST", `/plans/${at(plan)}/remedies`, { body: { kind } }),
  cancelPlan: (id: string) => request<undefined>("DELETE", `/plans/${at(id)}`),

  comparisons: () => request<Comparison[]>("GET", "/compare"),
  comparison: (id: string) => request<Comparison>("GET", `/compare/${at(id)}`),
  createComparison: (trajectory: string, rig: string, methods: string[]) =>
    request<Comparison>("POST", "/compare", { body: { trajectory, rig, methods } }),
  /** Cancels one that is under way, removes one that is not. */
  removeComparison: (id: string) => request<undefined>("DELETE", `/compare/${at(id)}`),

  command: (rig: string, command: string, args: object, lease: LeaseToken | null) =>
    request<CommandOut>("POST", `/rigs/${at(rig)}/commands`, { body: { command, args, lease }, withinMs: COMMAND_MS }),
  lease: (rig: string, action: LeaseAction) =>
    request<Lease>("POST", `/rigs/${at(rig)}/lease`, { body: { action }, withinMs: COMMAND_MS }),
  releaseLease: (rig: string) => request<Lease>("DELETE", `/rigs/${at(rig)}/lease`, { withinMs: COMMAND_MS }),
  stop: (rig: string) => request<CommandOut>("POST", `/rigs/${at(rig)}/stop`, { withinMs: STOP_MS }),
  estop: (rig: string) => request<CommandOut>("POST", `/rigs/${at(rig)}/estop`, { withinMs: STOP_MS }),

  runs: () => request<Run[]>("GET", "/runs"),
  run: (id: string) => request<Run>("GET", `/runs/${at(id)}`),
  exportUrl: (run: string, format: "csv" | "parquet" | "mcap") => `${BASE}/runs/${at(run)}/export?format=${format}`,

  /** Shows a plan's pose as a ghost beside the rig; null takes it away. */
  scenePose: (rig: string, pose: { plan_id: string; time_s: number } | null) =>
    request<ScenePose | null>("POST", `/rigs/${at(rig)}/scene/pose`, { body: pose, keepalive: pose === null }),

  streamUrl: (rig: string) => webSocket(`/rigs/${at(rig)}/stream`),
  replayUrl: (run: string) => webSocket(`/runs/${at(run)}/stream`),
  sceneUrl: (rig: string) => `/scene/${at(rig)}/`,
};

/** Uploads a flight; XMLHttpRequest because fetch does not tell how much of a body has been sent. */
export function upload(file: File, convention: string, progress: (fraction: number) => void): Promise<Trajectory> {
  const form = new FormData();
  form.set("name", file.name.replace(/\.(csv|parquet)$/i, ""));
  form.set("convention", convention);
  form.set("file", file);
  return new Promise((resolve, reject) => {
    const sending = new XMLHttpRequest();
    sending.open("POST", `${BASE}/trajectories`);
    sending.setRequestHeader("x-fullpose-client", me());
    sending.upload.onprogress = ({ loaded, total }) => progress(total > 0 ? loaded / total : 0);
    sending.onload = () => {
      if (sending.status >= 200 && sending.status < 300) resolve(JSON.parse(sending.responseText) as Trajectory);
      else reject(failure(sending.status, sending.responseText));
    };
    sending.onerror = () => reject(failure(0, ""));
    sending.send(form);
  });
}
