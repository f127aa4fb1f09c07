/** What every uPlot chart of the console shares: colours of the theme, axes, and limits drawn as bands. */
import type uPlot from "uplot";
import type { CurveEvent } from "../../contract/types";
import type { Range } from "../../rules/limits";

export interface Ink {
  text: string;
  grid: string;
  beyond: string;
  beyondLine: string;
  of: (variable: string) => string;
}

/** The theme's colours now; charts are made anew when the theme changes. */
export function ink(): Ink {
  const style = getComputedStyle(document.documentElement);
  const of = (variable: string): string => style.getPropertyValue(variable).trim();
  return { text: of("--text-3"), grid: of("--grid"), beyond: of("--beyond"), beyondLine: of("--beyond-line"), of };
}

/** A logarithmic scale; uPlot's own name for it is a const enum, which a build file by file cannot read. */
// eslint-disable-next-line @typescript-eslint/no-unsafe-enum-assignment
export const LOGARITHMIC: Pick<uPlot.Scale, "distr" | "log"> = { distr: 3, log: 10 };

/** A curve of a stretch of time. */
export interface SpanSeries {
  /** Ascending times [s], and a value each. */
  time: Float64Array;
  values: Float64Array;
  /** CSS variable of its colour. */
  colour: string;
  width?: number;
  dash?: number[];
}

export const AXIS_FONT = '11px "Inter", system-ui, sans-serif';

const plain = (value: number): string => String(value).replace("-", "−");

export interface AxisLook {
  size?: number;
  space?: number;
  splits?: number[];
  /** Text of each tick; a tick that uPlot leaves out has none. */
  text?: (value: number) => string | null;
}

export function axis(colours: Ink, look: AxisLook = {}): uPlot.Axis {
  const made: uPlot.Axis = {
    stroke: colours.text,
    font: AXIS_FONT,
    gap: 4,
    grid: { stroke: colours.grid, width: 1 },
    ticks: { show: false },
    space: look.space ?? 20,
  };
  if (look.size !== undefined) made.size = look.size;
  const splits = look.splits;
  if (splits) {
    made.splits = () => splits;
    made.filter = (_plot, ticks) => ticks; // on a log axis uPlot would leave some out
  }
  const text = look.text ?? plain;
  made.values = (_plot, ticks: (number | null)[]) => ticks.map((value) => (value === null ? null : text(value)));
  return made;
}

/** Shades what lies beyond the limits and draws a line at each, under the curves. */
export function limitBands(limits: () => Range | null, colours: Ink): uPlot.Plugin {
  return {
    hooks: {
      drawClear: (plot) => {
        const range = limits();
        const { min, max } = plot.scales["y"] ?? {};
        if (!range || min == null || max == null) return;
        const { ctx, bbox } = plot;
        const [low, high] = range;
        ctx.save();
        ctx.beginPath();
        ctx.rect(bbox.left, bbox.top, bbox.width, bbox.height);
        ctx.clip();
        const top = plot.valToPos(high, "y", true);
        const bottom = plot.valToPos(low, "y", true);
        ctx.fillStyle = colours.beyond;
        ctx.fillRect(bbox.left, bbox.top, bbox.width, top - bbox.top);
        ctx.fillRect(bbox.left, bottom, bbox.width, bbox.top + bbox.height - bottom);
        ctx.fillStyle = colours.beyondLine;
        ctx.fillRect(bbox.left, Math.round(top), bbox.width, 1);
        ctx.fillRect(bbox.left, Math.round(bottom), bbox.width, 1);
        ctx.restore();
      },
    },
  };
}

/** 1e-9 as "1e−9", as the console writes small numbers. */
export function powerOfTen(value: number): string {
  return value.toExponential(0).replace("-", "−").replace("+", "");
}

/** Ticks of a log axis: every fourth power of ten from `low` to `high`. */
export function everyFourth([low, high]: Range): number[] {
  const last = Math.floor(Math.log10(high) + 1e-9);
  const ticks: number[] = [];
  for (let exponent = Math.ceil(Math.log10(low) - 1e-9); exponent <= last; exponent++) {
    if (exponent % 4 === 0) ticks.push(10 ** exponent);
  }
  return ticks;
}

/** uPlot's gap is null; ours is not-a-number. */
export function withGaps(values: ArrayLike<number>, floor?: number): (number | null)[] {
  return Array.from(values, (value) =>
    Number.isNaN(value) ? null : floor === undefined ? value : Math.max(floor, value),
  );
}

const EVENT_COLOURS: Record<CurveEvent["kind"], string> = {
  alarm: "--danger",
  gap: "--caution",
  command: "--accent",
  transition: "--text-3",
  begin: "--text-3",
  end: "--text-3",
};

/** CSS variable of what an event is drawn with. */
export function colourOfEvent({ kind, severity }: CurveEvent): string {
  return severity === "warning" ? "--caution" : EVENT_COLOURS[kind];
}
