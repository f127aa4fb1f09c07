/** The REST API: one function a request. Paths, parameters, bodies and answers are those of the generated contract. */
import type {
  AlarmQuery,
  ArgsOf,
  ColumnMap,
  CommandBody,
  CommandName,
  ExportFormat,
  LabelsIn,
  LeaseAction,
  LeaseToken,
  RemedyKind,
  ScenePoseAt,
  Searched,
  TokenWanted,
  UserChange,
  UserWanted,
} from "../contract/types";
import { bytes, page, pathTo, request, socketTo } from "./request";
import { lookAt, upload } from "./upload";

/** How long an answer may take: to a Stop, to a command or the lease, and to what is read or begun. */
const STOP = { withinMs: 2000 };
const COMMAND = { withinMs: 10_000 };
const READ = { withinMs: 60_000 };
/** To who we are: nothing is shown before the first answer. */
const WHO = { withinMs: 5000 };
/** To one that answers a secret, which is told once: it is waited for though the rig's process has to start before. */
const GIVEN = { withinMs: 180_000 };

export const api = {
  /** Whether one must sign in here, and who one is. */
  me: () => request("get", "/api/v1/me", {}, WHO),
  login: (name: string, password: string) =>
    request("post", "/api/v1/login", {}, { ...READ, body: { name, password } }),
  logout: () => request("post", "/api/v1/logout", {}, COMMAND),
  changePassword: (current: string, next: string, revoke_tokens: boolean) =>
    request("put", "/api/v1/me/password", {}, { ...READ, body: { current, new: next, revoke_tokens } }),
  tokens: () => request("get", "/api/v1/tokens", {}, READ),
  makeToken: (body: TokenWanted) => request("post", "/api/v1/tokens", {}, { ...READ, body }),
  revokeToken: (token: string) => request("delete", "/api/v1/tokens/{token}", { token }, READ),
  users: () => request("get", "/api/v1/users", {}, READ),
  addUser: (body: UserWanted) => request("post", "/api/v1/users", {}, { ...READ, body }),
  changeUser: (name: string, body: UserChange) => request("put", "/api/v1/users/{name}", { name }, { ...READ, body }),

  health: () => request("get", "/api/v1/health", {}, READ),
  rigs: () => request("get", "/api/v1/rigs", {}, READ),
  methods: () => request("get", "/api/v1/methods", {}, READ),

  trajectories: (before: string | null = null, wanted: Searched = {}) =>
    page("/api/v1/trajectories", {}, wanted, before, READ.withinMs),
  preview: (sha256: string, points = 800) =>
    request("get", "/api/v1/trajectories/{sha256}/preview", { sha256 }, { ...READ, query: { points } }),
  diagnosis: (sha256: string, rig: string | null = null) =>
    request("get", "/api/v1/trajectories/{sha256}/diagnosis", { sha256 }, { ...READ, query: rig ? { rig } : {} }),
  /** What a tolerance does to a flight; without one, the one that is suggested. */
  tolerance: (sha256: string, tolerance_deg: number | null) =>
    request("get", "/api/v1/trajectories/{sha256}/tolerance", { sha256 }, { ...READ, query: { tolerance_deg } }),
  labelTrajectory: (sha256: string, body: LabelsIn) =>
    request("patch", "/api/v1/trajectories/{sha256}", { sha256 }, { ...READ, body }),
  deleteTrajectory: (sha256: string) => request("delete", "/api/v1/trajectories/{sha256}", { sha256 }, READ),
  upload,
  lookAt,
  profiles: () => request("get", "/api/v1/profiles", {}, READ),
  saveProfile: (name: string, about: string, columns: ColumnMap) =>
    request("put", "/api/v1/profiles/{name}", { name }, { ...READ, body: { about, columns } }),
  removeProfile: (name: string) => request("delete", "/api/v1/profiles/{name}", { name }, READ),

  plans: (before: string | null = null, wanted: Searched = {}) =>
    page("/api/v1/plans", {}, wanted, before, READ.withinMs),
  plan: (plan: string) => request("get", "/api/v1/plans/{plan}", { plan }, READ),
  planSamples: (plan: string, points = 1200) =>
    request("get", "/api/v1/plans/{plan}/samples", { plan }, { ...READ, query: { points } }),
  planPlane: (plan: string) => request("get", "/api/v1/plans/{plan}/plane", { plan }, READ),
  /** `tolerance_deg`: null for the flight as it is. */
  createPlan: (trajectory: string, rig: string, method: string, tolerance_deg: number | null) =>
    request("post", "/api/v1/plans", {}, { ...READ, body: { trajectory, rig, method, options: {}, tolerance_deg } }),
  createRemedy: (plan: string, kind: RemedyKind) =>
    request("post", "/api/v1/plans/{plan}/remedies", { plan }, { ...READ, body: { kind } }),
  planExportUrl: (plan: string, format: ExportFormat) => pathTo("/api/v1/plans/{plan}/export", { plan }, { format }),
  labelPlan: (plan: string, body: LabelsIn) => request("patch", "/api/v1/plans/{plan}", { plan }, { ...READ, body }),
  cancelPlan: (plan: string) => request("delete", "/api/v1/plans/{plan}", { plan }, READ),

  comparisons: (before: string | null = null) => page("/api/v1/compare", {}, {}, before, READ.withinMs),
  comparison: (comparison: string) => request("get", "/api/v1/compare/{comparison}", { comparison }, READ),
  /** `tolerance_deg`: null for the flight as it is. */
  createComparison: (trajectory: string, rig: string, methods: string[], tolerance_deg: number | null) =>
    request("post", "/api/v1/compare", {}, { ...READ, body: { trajectory, rig, methods, tolerance_deg } }),
  /** Cancels one that is under way, removes one that is not. */
  removeComparison: (comparison: string) => request("delete", "/api/v1/compare/{comparison}", { comparison }, READ),

  command: <Name extends CommandName>(rig: string, command: Name, args: ArgsOf<Name>, lease: LeaseToken | null) => {
    // What has a default may be left out; the generated types are those of an answer, in which it is always there.
    const body = { command, args, lease } as CommandBody;
    return request("post", "/api/v1/rigs/{rig}/commands", { rig }, { ...COMMAND, body });
  },
  /** `secret`: the lease's, for what only its holder may do; `reason`: why it is taken over. */
  lease: (rig: string, action: LeaseAction, secret?: string, reason: string | null = null) =>
    request(
      "post",
      "/api/v1/rigs/{rig}/lease",
      { rig },
      { ...(secret === undefined ? GIVEN : COMMAND), body: { action, secret: secret ?? null, reason } },
    ),
  /** Gives the lease up, from a page that is being left. */
  leave: (rig: string, secret: string) =>
    request(
      "post",
      "/api/v1/rigs/{rig}/lease",
      { rig },
      { ...COMMAND, body: { action: "release", secret, reason: null }, keepalive: true },
    ),
  stop: (rig: string) => request("post", "/api/v1/rigs/{rig}/stop", { rig }, STOP),
  estop: (rig: string) => request("post", "/api/v1/rigs/{rig}/estop", { rig }, STOP),

  runs: (before: string | null = null, wanted: Searched = {}) =>
    page("/api/v1/runs", {}, wanted, before, READ.withinMs),
  run: (run: string) => request("get", "/api/v1/runs/{run}", { run }, READ),
  labelRun: (run: string, body: LabelsIn) => request("patch", "/api/v1/runs/{run}", { run }, { ...READ, body }),
  deleteRun: (run: string) => request("delete", "/api/v1/runs/{run}", { run }, READ),
  pinRun: (run: string) => request("put", "/api/v1/runs/{run}/pin", { run }, READ),
  unpinRun: (run: string) => request("delete", "/api/v1/runs/{run}/pin", { run }, READ),
  /** What there is to draw of a run, alone or `against` another run or a plan; asked again until it is ready. */
  curves: (run: string, against: string | null = null) =>
    request("get", "/api/v1/runs/{run}/curves", { run }, { ...READ, query: { against } }),
  /** A window of it, in the binary form that `net/curves` reads. */
  curvesWindow: (run: string, from_s: number, to_s: number, width: number, against: string | null = null) =>
    bytes("/api/v1/runs/{run}/curves/window", { run }, { from_s, to_s, width, against }, READ.withinMs),
  /** The kinds of file that plans and runs are downloaded as. */
  exports: () => request("get", "/api/v1/exports", {}, READ),
  evidenceUrl: (run: string) => pathTo("/api/v1/runs/{run}/evidence", { run }),
  exportUrl: (run: string, format: ExportFormat) => pathTo("/api/v1/runs/{run}/export", { run }, { format }),

  alarms: (wanted: AlarmQuery, before: string | null = null) =>
    page("/api/v1/alarms", {}, wanted, before, READ.withinMs),
  audit: (before: string | null = null) => page("/api/v1/audit", {}, {}, before, READ.withinMs),

  /** Shows a plan's pose as a ghost beside the rig; null takes it away, also from a page that is being left. */
  scenePose: (rig: string, body: ScenePoseAt | null) =>
    request("post", "/api/v1/rigs/{rig}/scene/pose", { rig }, { ...READ, body, keepalive: body === null }),

  streamUrl: (rig: string) => socketTo("/api/v1/rigs/{rig}/stream", { rig }),
  replayUrl: (run: string) => socketTo("/api/v1/runs/{run}/stream", { run }),
};

export type Api = typeof api;
