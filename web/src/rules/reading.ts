/** How a file is read: columns that are given by hand, and what this browser remembers of files like it. */
import type { ColumnMap, Convention, HowToRead, ReadingPreview } from "../contract/types";

export type TimeUnit = ColumnMap["time"]["unit"];
type Euler = NonNullable<ColumnMap["euler"]>;
type Quaternion = NonNullable<ColumnMap["quaternion"]>;

export const TIME_UNITS: readonly NonNullable<TimeUnit>[] = ["s", "ms", "0.1ms", "us", "ns", "min", "h"];
export const ANGLE_UNITS: readonly NonNullable<Euler["unit"]>[] = ["deg", "rad", "centideg"];
export const ORDERS: readonly Euler["order"][] = [
  ...(["ZYX", "YZX", "XYZ", "XZY", "YXZ", "ZXY"] as const),
  ...(["XYX", "XZX", "YXY", "YZY", "ZXZ", "ZYZ"] as const),
];

/** A column map as it is filled in; `columns` has four of a quaternion (w, x, y, z), three of angles. */
export interface Draft {
  axes: Convention;
  time: string;
  timeUnit: NonNullable<TimeUnit>;
  kind: "euler" | "quaternion";
  columns: string[];
  order: Euler["order"];
  unit: NonNullable<Euler["unit"]>;
  sense: NonNullable<Quaternion["sense"]>;
}

/** What is filled in to begin with: what was taken, else the file's first columns. */
export function draftOf(found: Pick<ReadingPreview, "columns" | "names">): Draft {
  const taken = found.columns;
  const names = found.names;
  return {
    axes: taken?.axes ?? "ned",
    time: taken?.time.column ?? names[0] ?? "",
    timeUnit: taken?.time.unit ?? "s",
    kind: taken?.quaternion ? "quaternion" : "euler",
    columns: [...(taken?.quaternion?.columns ?? taken?.euler?.columns ?? names.slice(1, 4))],
    order: taken?.euler?.order ?? (taken?.axes === "nue" ? "YZX" : "ZYX"),
    unit: taken?.euler?.unit ?? "deg",
    sense: taken?.quaternion?.sense ?? "body_to_reference",
  };
}

/** How many columns its attitude has. */
export const widthOf = (kind: Draft["kind"]): 3 | 4 => (kind === "quaternion" ? 4 : 3);

/** What each column is, in the order of `columns`. */
export function rolesOf({ kind, order }: Pick<Draft, "kind" | "order">): string[] {
  if (kind === "quaternion") return ["w", "x", "y", "z"];
  return ["First", "Second", "Third"].map((word, k) => `${word} angle, about ${(order[k] ?? "").toLowerCase()}`);
}

/** The column map; null while a column is missing or stands for two things. */
export function mapOf(draft: Draft): ColumnMap | null {
  const columns = draft.columns.slice(0, widthOf(draft.kind));
  const all = [draft.time, ...columns];
  if (columns.length < widthOf(draft.kind) || all.includes("") || new Set(all).size < all.length) return null;
  const time = { column: draft.time, unit: draft.timeUnit, epoch: "first" as const };
  const [a, b, c, d] = columns as [string, string, string, string];
  if (draft.kind === "quaternion") {
    return { axes: draft.axes, time, euler: null, quaternion: { columns: [a, b, c, d], sense: draft.sense } };
  }
  return {
    axes: draft.axes,
    time,
    euler: { columns: [a, b, c], order: draft.order, unit: draft.unit },
    quaternion: null,
  };
}

const KEY = "fullpose.reading";
const MOST = 30;
type Kept = Pick<HowToRead, "profile" | "convention" | "columns">;

/** What was chosen in this browser for the last file with these columns. */
export function remembered(names: readonly string[]): Kept | null {
  return kept().find(([of]) => of === names.join("\t"))?.[1] ?? null;
}

/** Remembers how a file with these columns was read. */
export function remember(names: readonly string[], { profile, convention, columns }: HowToRead): void {
  const of = names.join("\t");
  const how = Object.fromEntries(Object.entries({ profile, convention, columns }).filter(([, said]) => said));
  const others = kept().filter(([other]) => other !== of);
  localStorage.setItem(KEY, JSON.stringify([[of, how], ...others].slice(0, MOST)));
}

function kept(): [string, Kept][] {
  try {
    return JSON.parse(localStorage.getItem(KEY) ?? "[]") as [string, Kept][];
  } catch {
    return [];
  }
}
