/** The plane of time and base angle under a plot of the base over time. */
import type uPlot from "uplot";
import { shade, type PlaneCells, type Side } from "../../rules/plane";

const HATCH = 8;

/** A pixel a cell, see-through where no path passes; the first base angle is the lowest row. */
export function planeImage(cells: PlaneCells, side: Side): HTMLCanvasElement {
  const image = document.createElement("canvas");
  image.width = cells.columns;
  image.height = cells.rows;
  const ink = image.getContext("2d");
  if (!ink) return image;
  const pixels = ink.createImageData(cells.columns, cells.rows);
  for (let column = 0; column < cells.columns; column++) {
    for (let row = 0; row < cells.rows; row++) {
      const { margin } = cells.at(column, row, side);
      if (margin >= 0) pixels.data.set([...shade(margin), 255], 4 * ((cells.rows - 1 - row) * cells.columns + column));
    }
  }
  ink.putImageData(pixels, 0, 0);
  return image;
}

/** Grey stripes at the size of the screen's pixels. */
function hatch(ink: CanvasRenderingContext2D): CanvasPattern | null {
  const tile = document.createElement("canvas");
  const size = HATCH * Math.max(1, Math.round(devicePixelRatio));
  tile.width = tile.height = size;
  const stripes = tile.getContext("2d");
  if (!stripes) return null;
  stripes.fillStyle = "#7d828b";
  stripes.fillRect(0, 0, size, size);
  stripes.strokeStyle = "#a3a8b0";
  stripes.lineWidth = size / 5;
  for (const offset of [-size, 0, size]) {
    stripes.beginPath();
    stripes.moveTo(offset, size);
    stripes.lineTo(offset + size, 0);
    stripes.stroke();
  }
  return ink.createPattern(tile, "repeat");
}

/** Draws the image where its times and base angles are, and the needles as rings with their half widths. */
export function planeBackdrop(cells: PlaneCells, image: HTMLCanvasElement): (plot: uPlot) => void {
  const { time_s: time, base_deg: base, needles } = cells.plane;
  const first = time[0] ?? 0;
  const last = time.at(-1) ?? 0;
  return (plot) => {
    const { ctx, bbox } = plot;
    const x = (timeS: number): number => plot.valToPos(timeS, "x", true);
    const y = (baseDeg: number): number => plot.valToPos(baseDeg, "y", true);
    const [left, right, top, bottom] = [x(first), x(last), y(base[1]), y(base[0])];
    ctx.save();
    ctx.beginPath();
    ctx.rect(bbox.left, bbox.top, bbox.width, bbox.height);
    ctx.clip();
    ctx.fillStyle = hatch(ctx) ?? "#7d828b";
    ctx.fillRect(left, top, right - left, bottom - top);
    ctx.imageSmoothingEnabled = false;
    const half = { x: (right - left) / (cells.columns - 1) / 2, y: (bottom - top) / (cells.rows - 1) / 2 };
    ctx.drawImage(image, left - half.x, top - half.y, right - left + 2 * half.x, bottom - top + 2 * half.y);
    for (const needle of needles) {
      // Half a turn on is another.
      for (let k = Math.ceil((base[0] - needle.base_deg) / 180); needle.base_deg + 180 * k <= base[1]; k++) {
        ring(ctx, x(needle.time_s), y, needle.base_deg + 180 * k, needle.half_width_deg);
      }
    }
    ctx.restore();
  };
}

function ring(
  ctx: CanvasRenderingContext2D,
  x: number,
  y: (deg: number) => number,
  baseDeg: number,
  halfDeg: number,
): void {
  const size = devicePixelRatio;
  for (const [width, colour] of [
    [4, "#000000"],
    [2, "#ffffff"],
  ] as const) {
    ctx.strokeStyle = colour;
    ctx.lineWidth = width * size;
    ctx.beginPath();
    ctx.moveTo(x, y(baseDeg - halfDeg));
    ctx.lineTo(x, y(baseDeg + halfDeg));
    ctx.stroke();
    ctx.beginPath();
    ctx.arc(x, y(baseDeg), 4 * size, 0, 2 * Math.PI);
    ctx.stroke();
  }
}
