/** Methods side by side: the columns of the table, which values are the best, and what a method comes to. */
import { FRAMES, type Comparison, type MethodFigures, type Peak } from "../contract/types";
import { fixed, integer, scientific } from "./format";

export interface Standing {
  tone: "good" | "caution" | "danger" | "";
  word: string;
  /** Why, in a few words. */
  detail: string;
}

export interface Column {
  key: string;
  heading: string;
  unit: string;
  tip: string;
  value: (method: MethodFigures) => number | null;
  text: (method: MethodFigures) => string;
  /** A second figure, under the first. */
  more?: (method: MethodFigures) => string | null;
  better: "low" | "high";
  /** Whether a value is a failing of its own, however the others do. */
  bad: (method: MethodFigures) => "danger" | "caution" | "";
  /** Whether only methods that could be flown compete: low effort is no merit of a method that misses the flight. */
  fitOnly: boolean;
  /** Values below this are rounding, hence equal; of the bound of exactness [deg]. */
  floor?: (exactWithinDeg: number) => number;
}

/** Exact at every sample and inside every limit. */
export function fit(method: MethodFigures): boolean {
  return method.refusal === null && method.feasible === true && method.exact_share === 1;
}

export function standingOf(method: MethodFigures): Standing {
  if (method.refusal !== null) return { tone: "", word: "Does not apply", detail: method.refusal };
  if (method.feasible === false)
    return { tone: "danger", word: "Not feasible", detail: beyond(method) ?? missed(method) ?? "" };
  if (method.exact_share !== 1) return { tone: "caution", word: "Not exact", detail: missed(method) ?? "" };
  return { tone: "good", word: "Exact, inside limits", detail: "" };
}

export interface Sentence {
  label: string;
  text: string;
  /** What a verdict of the planner rests on, for whoever asks. */
  howSure: string | null;
}

/** What keeps each method from it, first and then: of those that it keeps. */
export function sentencesOf(methods: readonly MethodFigures[]): Sentence[] {
  return methods.flatMap(({ label, why, how_sure: howSure, feasible }) =>
    why ? [{ label, text: sentence(why), howSure: feasible ? null : (howSure ?? null) }] : [],
  );
}

/** What a tolerance would do for a flight whose recording is what no method can fly. */
export function adviceOf(report: NonNullable<Comparison["report"]>): string | null {
  const suggested = report.suggested_tolerance_deg;
  if (!suggested || (report.tolerance_deg ?? 0) >= suggested) return null;
  return `A tolerance of ${suggested} deg takes away what the recording added.`;
}

const sentence = (text: string): string => `${text.charAt(0).toUpperCase()}${text.slice(1)}.`;

/** The frame and limit that most samples are beyond. */
function beyond({ limit_violation_counts: counts }: MethodFigures): string | null {
  const all = Object.entries(counts ?? {}).flatMap(([frame, kinds]) =>
    Object.entries(kinds).map(([limit, samples]) => ({ what: `${frame} ${limit}`, samples })),
  );
  const worst = all.sort((a, b) => b.samples - a.samples)[0];
  return worst && worst.samples > 0 ? `${worst.what}, ${samplesOf(worst.samples)}` : null;
}

function missed({ failures }: MethodFigures): string | null {
  const first = failures?.[0];
  return first ? `${first.reason}, ${samplesOf(first.samples)}` : null;
}

const samplesOf = (count: number): string => `${integer(count)} ${count === 1 ? "sample" : "samples"}`;

function largest(method: MethodFigures, key: keyof Peak): number | null {
  const peaks = FRAMES.flatMap((frame) => method.peak?.[frame]?.[key] ?? []);
  return peaks.length > 0 ? Math.max(...peaks) : null;
}

/** Share of exact samples; all and none only of all and none. The server rounds it, the same for every table. */
export function exactText({ exact_percent: percent, exact_samples: samples }: MethodFigures): string {
  if (percent === null || percent === undefined) return fixed(null, 0);
  if (percent === 0 && samples) return "< 0.01 %";
  return `${fixed(percent, percent === 0 || percent === 100 ? 0 : 2)} %`;
}

/** A method that stops before its first sample has counted none. */
function counted({ iterations }: MethodFigures): { median: number; max: number } | null {
  return iterations && iterations.max > 0 ? iterations : null;
}

/** Way of all frames together [deg]. */
function way({ total_variation_deg: ways }: MethodFigures): number | null {
  return ways ? Object.values(ways).reduce((sum, each) => sum + each, 0) : null;
}

const fine = (): "" => "";

export const COLUMNS: readonly Column[] = [
  {
    key: "exact",
    heading: "Exact",
    unit: "",
    tip: "Share of the samples that reproduce the attitude",
    value: ({ exact_share }) => exact_share ?? null,
    text: exactText,
    better: "high",
    bad: ({ exact_share }) => (exact_share === 1 ? "" : "caution"),
    fitOnly: false,
  },
  {
    key: "largest",
    heading: "Largest error",
    unit: "deg",
    tip: "Geodesic attitude error",
    value: ({ max_error_deg }) => max_error_deg ?? null,
    text: ({ max_error_deg }) => scientific(max_error_deg),
    better: "low",
    bad: fine,
    fitOnly: false,
    floor: (exactWithinDeg) => exactWithinDeg,
  },
  {
    key: "rms",
    heading: "RMS error",
    unit: "deg",
    tip: "Geodesic attitude error",
    value: ({ rms_error_deg }) => rms_error_deg ?? null,
    text: ({ rms_error_deg }) => scientific(rms_error_deg),
    better: "low",
    bad: fine,
    fitOnly: false,
    floor: (exactWithinDeg) => exactWithinDeg,
  },
  {
    key: "matrix",
    heading: "Matrix error",
    unit: "1",
    tip: "Largest entry of the difference of the attitude matrices",
    value: ({ max_matrix_error }) => max_matrix_error ?? null,
    text: ({ max_matrix_error }) => scientific(max_matrix_error),
    better: "low",
    bad: fine,
    fitOnly: false,
    floor: (exactWithinDeg) => (exactWithinDeg * Math.PI) / 180,
  },
  {
    key: "violations",
    heading: "Beyond limits",
    unit: "samples",
    tip: "Samples beyond a limit of any frame",
    value: ({ limit_violation_samples }) => limit_violation_samples ?? null,
    text: ({ limit_violation_samples }) => integer(limit_violation_samples),
    better: "low",
    bad: ({ limit_violation_samples }) => ((limit_violation_samples ?? 0) > 0 ? "danger" : ""),
    fitOnly: false,
  },
  {
    key: "limited",
    heading: "Limited",
    unit: "samples",
    tip: "Samples that the method itself marked as kept from the attitude by a limit",
    value: ({ limited_samples }) => limited_samples ?? null,
    text: ({ limited_samples }) => integer(limited_samples),
    better: "low",
    bad: ({ limited_samples }) => ((limited_samples ?? 0) > 0 ? "caution" : ""),
    fitOnly: false,
  },
  {
    key: "rate",
    heading: "Peak rate",
    unit: "deg/s",
    tip: "Of any frame",
    value: (method) => largest(method, "rate_deg_s"),
    text: (method) => big(largest(method, "rate_deg_s"), 1),
    better: "low",
    bad: fine,
    fitOnly: true,
  },
  {
    key: "acceleration",
    heading: "Peak acceleration",
    unit: "deg/s²",
    tip: "Of any frame",
    value: (method) => largest(method, "acceleration_deg_s2"),
    text: (method) => big(largest(method, "acceleration_deg_s2"), 1),
    better: "low",
    bad: fine,
    fitOnly: true,
  },
  {
    key: "way",
    heading: "Total way",
    unit: "deg",
    tip: "Total variation of all frames",
    value: way,
    text: (method) => big(way(method), 0),
    better: "low",
    bad: fine,
    fitOnly: true,
  },
  {
    key: "iterations",
    heading: "Iterations",
    unit: "median",
    tip: "A step, median; the most is under it",
    value: (method) => counted(method)?.median ?? null,
    text: (method) => fixed(counted(method)?.median, 0),
    more: (method) => (counted(method) ? `most ${counted(method)?.max}` : null),
    better: "low",
    bad: fine,
    fitOnly: true,
  },
  {
    key: "step",
    heading: "Step",
    unit: "µs",
    tip: "Median of a step on the server's machine; the 99th percentile is under it",
    value: ({ step_us }) => step_us?.median ?? null,
    text: ({ step_us }) => (step_us ? microseconds(step_us.median) : fixed(null, 0)),
    more: ({ step_us }) => (step_us ? `p99 ${microseconds(step_us.p99)}` : null),
    better: "low",
    bad: fine,
    fitOnly: true,
  },
];

const microseconds = (value: number): string => fixed(value, value < 10 ? 2 : value < 1000 ? 1 : 0);

/** A peak in plain digits up to five of them: an impossible one is a power of ten. */
function big(value: number | null, digits: number): string {
  return value !== null && value >= 1e5 ? scientific(value) : fixed(value, digits);
}

/** Values this close to each other are read as the same [relative]. */
const SAME = 1e-3;
/** A mark that most methods have says nothing [share of them]. */
const MOST = 2 / 3;

/**
 * The methods whose value in a column is the best; none where most of them share it.
 * Errors below the bound `exactWithinDeg` are rounding, hence equal.
 */
export function best(column: Column, methods: readonly MethodFigures[], exactWithinDeg: number): ReadonlySet<string> {
  const floor = column.floor?.(exactWithinDeg) ?? 0;
  const rivals = methods.flatMap((method) => {
    const value = method.refusal !== null || (column.fitOnly && !fit(method)) ? null : column.value(method);
    return value === null ? [] : [{ name: method.label, value: Math.max(value, floor) }];
  });
  const values = rivals.map(({ value }) => value);
  const top = column.better === "low" ? Math.min(...values) : Math.max(...values);
  const winners = rivals.filter(({ value }) => Math.abs(value - top) <= SAME * Math.abs(top));
  return new Set(winners.length <= MOST * rivals.length ? winners.map(({ name }) => name) : []);
}

/** Those that can be flown first, then the ones nearer to it; the order asked for is kept within a rank. */
export function ranked(methods: readonly MethodFigures[]): MethodFigures[] {
  const rank = (method: MethodFigures): number => ["good", "caution", "danger", ""].indexOf(standingOf(method).tone);
  return [...methods].sort((a, b) => rank(a) - rank(b));
}

const STATUSES: Record<Comparison["status"], { word: string; tone: "active" | "danger" | "" }> = {
  queued: { word: "Queued", tone: "active" },
  running: { word: "Comparing", tone: "active" },
  done: { word: "Done", tone: "" },
  failed: { word: "Failed", tone: "danger" },
  cancelled: { word: "Cancelled", tone: "" },
  interrupted: { word: "Interrupted", tone: "" },
};

export const statusOf = (status: Comparison["status"]): { word: string; tone: string } => STATUSES[status];

/** One line on what came out of it. */
export function summaryOf({ report }: Pick<Comparison, "report">): string {
  if (!report) return "";
  const able = report.methods.filter(fit);
  if (able.length === 0) return "No method flies this exactly within the limits of the rig.";
  const names = able.map(({ label }) => label);
  if (able.length === report.methods.length) return "All methods fly it exactly within the limits.";
  const list = names.length === 1 ? names[0] : `${names.slice(0, -1).join(", ")} and ${names.at(-1)}`;
  return `${list} ${names.length === 1 ? "flies" : "fly"} it exactly within the limits.`;
}
