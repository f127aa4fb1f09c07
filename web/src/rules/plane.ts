/** The plane of time and base angle of a plan: its cells, what they say in words, and their colours. */
import { FRAMES, type Plane } from "../contract/types";
import { fixed } from "./format";
import { LIMITS } from "./margins";

/** Whose side of cos d3 is shown: that of the plan at each time, or the one with more margin. */
export type Side = "flown" | "best";

export interface Cell {
  /** Per cent of the limits that a path can leave at most; negative: none passes inside them. */
  margin: number;
  /** Codes of the limit that leaves no more, and of the rate limit that holds it; 0: none. */
  binding: number;
  against: number;
}

const bytesOf = (text: string): Uint8Array => Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0));

/** The map, unpacked. */
export class PlaneCells {
  readonly columns: number;
  readonly rows: number;
  readonly #margin: Int8Array;
  readonly #limits: Uint8Array;

  constructor(readonly plane: Plane) {
    this.columns = plane.time_s.length;
    this.rows = plane.rows;
    this.#margin = new Int8Array(bytesOf(plane.margin).buffer);
    this.#limits = bytesOf(plane.limits);
  }

  at(column: number, row: number, side: Side): Cell {
    const flown = this.#index(column, row, this.plane.path.side[column] ?? 0);
    let index = flown;
    if (side === "best") {
      const [first, second] = [this.#index(column, row, 0), this.#index(column, row, 1)];
      index = (this.#margin[second] ?? 0) > (this.#margin[first] ?? 0) ? second : first;
    }
    const limits = this.#limits[index] ?? 0;
    return { margin: this.#margin[index] ?? 0, binding: limits & 15, against: limits >> 4 };
  }

  /** The row of a base angle [deg], the nearest there is. */
  row(baseDeg: number): number {
    const [low, high] = this.plane.base_deg;
    const row = Math.round(((baseDeg - low) / (high - low)) * (this.rows - 1));
    return Math.min(Math.max(row, 0), this.rows - 1);
  }

  #index(column: number, row: number, side: number): number {
    return (side * this.columns + column) * this.rows + row;
  }
}

/** Codes go frame by frame over the limits that rigs have had from the first; those of jerk came later, after them. */
const A_FRAME = LIMITS.indexOf("jerk");
const FIRST_JERK = 1 + FRAMES.length * A_FRAME;

/** "the outer frame's rate limit", of a code (`fullpose.bounds.limited_code`). */
export function limitOf(code: number): string {
  const jerk = code >= FIRST_JERK;
  const frame = FRAMES[jerk ? code - FIRST_JERK : Math.floor((code - 1) / A_FRAME)];
  const limit = jerk ? "jerk" : LIMITS[(code - 1) % A_FRAME];
  return frame && limit ? `the ${frame} frame's ${limit} limit` : "no limit";
}

/** What a point of the plane says. */
export function cellSentence({ margin, binding, against }: Cell, timeS: number, baseDeg: number): string {
  const where = `At ${fixed(timeS, 3)} s with the base at ${fixed(baseDeg, 1)} deg`;
  if (binding === 0) return `${where} no limit is asked for anything.`;
  const held = against === 0 ? "" : ` against ${limitOf(against)}`;
  if (margin < 0) return `${where} no path passes: ${limitOf(binding)}${held}.`;
  return `${where} a path can leave ${fixed(margin, 0)} % at most: ${limitOf(binding)}${held}.`;
}

/** What the plan does in a column. */
export function pathSentence({ path }: Plane, column: number): string {
  const [margin, code] = [path.margin[column] ?? 0, path.limit[column] ?? 0];
  if (code === 0) return "The plan asks nothing of a limit about then.";
  if (margin < 0) return `The plan goes beyond ${limitOf(code)} about then.`;
  return `The plan leaves ${fixed(margin, 0)} % of ${limitOf(code)} about then.`;
}

/** Viridis (Smith and van der Walt): as light as it is large, also to who sees no red or no green. */
const SHADES = [
  [0x44, 0x01, 0x54],
  [0x47, 0x2d, 0x7b],
  [0x3b, 0x52, 0x8b],
  [0x2c, 0x72, 0x8e],
  [0x21, 0x91, 0x8c],
  [0x28, 0xae, 0x80],
  [0x5e, 0xc9, 0x62],
  [0xad, 0xdc, 0x30],
  [0xfd, 0xe7, 0x25],
] as const;

/** Where a margin [per cent] stands on the scale, 0 to 1: by its root, for what is tight is looked at. */
export const onScale = (margin: number): number => Math.sqrt(Math.min(Math.max(margin, 0), 100) / 100);

/** The colour of a margin [per cent] from 0 to 100: red, green, blue. */
export function shade(margin: number): [number, number, number] {
  const at = onScale(margin) * (SHADES.length - 1);
  const low = Math.min(Math.floor(at), SHADES.length - 2);
  const [a, b] = [SHADES[low] ?? SHADES[0], SHADES[low + 1] ?? SHADES[0]];
  const mixed = (i: 0 | 1 | 2): number => Math.round(a[i] + (at - low) * (b[i] - a[i]));
  return [mixed(0), mixed(1), mixed(2)];
}

/** The scale as a background from left to right. */
export const SCALE = `linear-gradient(90deg, ${SHADES.map((colour) => `rgb(${colour.join(" ")})`).join(", ")})`;
export const TICKS: readonly number[] = [0, 5, 25, 50, 100];
