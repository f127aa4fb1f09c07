/** Messages as the server sends them, for tests: whole, and ordinary in all that a test does not say. */
import type {
  Alarm,
  Diagnosis,
  Lease,
  LeaseGiven,
  Rig,
  Run,
  Snapshot,
  ToleranceEffect,
  Trajectory,
} from "../contract/types";
import { me } from "../net/identity";

export function leaseOf(holder: string | null, given: Partial<Lease> = {}): Lease {
  return { holder, epoch: 3, sequence: 0, expires_s: 10, requested_by: [], ...given };
}

/** What who takes it, or asks for it, is told. */
export const givenLease = (lease: Lease, secret = "a-secret"): LeaseGiven => ({ ...lease, secret });

/** Ours. */
export const ourLease = (given: Partial<Lease> = {}): Lease => leaseOf(me(), given);

export function alarm(given: Partial<Alarm> = {}): Alarm {
  return {
    number: 1,
    code: "rate_limit",
    severity: "fault",
    message: "inner is too fast",
    first: false,
    count: 1,
    time_s: 0,
    shelved: false,
    ...given,
  };
}

export function session(given: Partial<Snapshot> = {}): Snapshot {
  return {
    rig: "bench",
    state: "armed",
    revision: 1,
    allowed: ["start", "hold", "move", "jog", "home", "disarm", "acknowledge", "load", "reset"],
    drive: "simulated",
    lease: leaseOf(null),
    plan: null,
    alarms: [],
    history: [],
    shelves: [],
    pose_deg: null,
    run_id: null,
    health: {
      rig_alive: true,
      rig_pid: 1,
      rate_hz: 1000,
      ticks: 1,
      busy_us: 1,
      deadline_misses: 0,
      heartbeat_age_s: 0,
      lateness_us: { p50: 1, p99: 2, p999: 3, max: 4 },
      realtime: "SCHED_FIFO",
      recorder: null,
    },
    ...given,
  };
}

const LIMITS = {
  min_deg: -170,
  max_deg: 170,
  max_rate_deg_s: 200,
  max_acceleration_deg_s2: 500,
  max_jerk_deg_s3: null,
  weight: 1,
  home_deg: 0,
};

export const RIG: Rig = {
  name: "bench",
  geometry: "vertical-4",
  redundant: true,
  builtin: false,
  rig_hash: "0",
  frames: { base: LIMITS, outer: LIMITS, middle: LIMITS, inner: LIMITS },
  payload: {},
  state: "armed",
  scene: "/scene/bench/",
};

export const FLIGHT: Trajectory = {
  sha256: "f",
  name: "loop",
  convention: "nue",
  input: null,
  created_at: "2026-11-01T12:00:00Z",
  duration_s: 10,
  samples: 1001,
  rate_hz: 100,
  uniform: true,
  start_s: 0,
  peak_body_rate_deg_s: 50,
  source_bytes: 1000,
  source_format: "csv",
  source_sha256: "s",
  warnings: [],
  tags: [],
  notes: "",
};

export function runOf(given: Partial<Run> = {}): Run {
  return {
    id: "r1",
    rig: "bench",
    incident: null,
    error: null,
    plan_id: "p",
    plan_hash: "h",
    who: "ann",
    started_at: "2026-11-01T12:00:00Z",
    ended_at: "2026-11-01T12:00:10Z",
    duration_s: 10,
    samples: 10_000,
    lost_samples: 0,
    bytes: 1000,
    pinned: false,
    complete: true,
    max_solve_error_deg: 1e-12,
    max_tracking_error_deg: 0.1,
    max_lateness_us: 50,
    end: "completed",
    end_code: null,
    tags: [],
    notes: "",
    ...given,
  };
}

export function diagnosisOf(given: Partial<Diagnosis> = {}): Diagnosis {
  const peak = { max: 50, time_s: 1, axes: [50, 0, 0], axes_time_s: [1, 0, 0] } satisfies Diagnosis["body_rate_deg_s"];
  return {
    samples: 1001,
    duration_s: 10,
    step_s: { median: 0.01, min: 0.01, max: 0.01 },
    white_noise_deg: [0, 0, 0],
    noise_measured: true,
    noise_acceleration_deg_s2: [0, 0, 0],
    quantum: null,
    held: null,
    stamps: { jitter_rms_s: 0, jitter_max_s: 0, quantum_s: 0, regular_rate_hz: null },
    near_duplicate_samples: 0,
    near_duplicates: [],
    gap_count: 0,
    gaps: [],
    outlier_samples: 0,
    outliers: [],
    body_rate_deg_s: peak,
    body_acceleration_deg_s2: peak,
    rig: null,
    findings: [],
    plots: {
      noise: { time_s: [], x_deg: [], y_deg: [], z_deg: [] },
      steps: { edge_s: [0.005, 0.01, 0.015], count: [0, 1000] },
    },
    ...given,
  };
}

/** Of a flight with 0.01 deg of noise, within what is suggested. */
export function effect(given: Partial<ToleranceEffect> = {}): ToleranceEffect {
  return {
    samples: 6001,
    needed: true,
    tolerance_deg: 0.05,
    suggested_tolerance_deg: 0.05,
    tolerance_floor_deg: 0.04,
    within_tolerance: true,
    deviation_deg: { max: 0.045, rms: 0.017 },
    cut_off_hz: 5.3,
    smoothing: "what is faster than 5.3 Hz taken away, up to 0.045 deg",
    recorded: { rate_deg_s: 92, acceleration_deg_s2: 24_500 },
    flown: { rate_deg_s: 60, acceleration_deg_s2: 152 },
    time_s: [0, 1],
    deviation_at_deg: [0.01, 0.045],
    ...given,
  };
}
