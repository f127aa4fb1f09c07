"""A record's plots as one vector drawing (SVG): angles, shares of the limits, errors, alarms as marks.

Every extreme of the record is in it: of the samples that share a column of the drawing the smallest and the largest
are drawn.
"""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from xml.sax.saxutils import escape

import numpy as np

from fullpose._typing import Array
from fullpose.rig import FRAMES, Rig
from fullpose_server.runtime.contract.telemetry import Samples

WIDTH, LEFT, RIGHT = 720.0, 46.0, 10.0
HEIGHT, GAP, TOP, BOTTOM = 138.0, 20.0, 14.0, 26.0  # of one plot, between two, above and below all
COLUMNS = 660  # of the drawing
COLOURS = ("#0072b2", "#d55e00", "#009e73", "#a65fa0")
_MARK = "#b00020"
_GREY = "#888888"
_LOWEST = -9.0  # decades of a degree: below is rounding
_STYLE = 'font-family="DejaVu Sans Mono" font-size="7.5" fill="#333"'
_TICKS = 4
_NEAR_S = 5.0  # what an alarm may be outside the record, to be drawn at its edge


@dataclass(frozen=True)
class Mark:
    """An alarm: when [s] after the first sample, and the letter that the report's table has for it."""

    time_s: float
    letter: str


@dataclass(frozen=True)
class Line:
    """One curve: its values (n,), nan where there is none."""

    values: Array
    colour: str
    width: float = 0.9
    dashes: str = ""
    opacity: float = 1.0


@dataclass(frozen=True)
class Axes:
    """Curves over the record's time. `limit`: a line to stay below; `logarithmic`: decades, above 0 alone."""

    title: str
    lines: Sequence[Line]
    limit: float | None = None
    logarithmic: bool = False
    legend: Sequence[tuple[str, str]] = ()  # a name and its colour, each


def run_plots(rows: Samples, rig: Rig | None, alarm_times: Sequence[Mark] = ()) -> str:
    """The drawing of a whole record; `rig` None: rates in deg/s, for no limit is known."""
    time_s = (rows["time_ns"] - rows["time_ns"][0]) / 1e9 if len(rows) else np.empty(0)
    return drawing(time_s, all_axes(rows, rig), alarm_times)


def all_axes(rows: Samples, rig: Rig | None) -> list[Axes]:
    """What is drawn of a record."""
    frames = list(range(4)) if rig is None else list(rig.geometry.frames)
    names = [(FRAMES[index].value, COLOURS[index]) for index in frames]
    angles = [Line(rows["measured"][:, i], COLOURS[i], 2.4, opacity=0.35) for i in frames]
    angles += [Line(rows["demand"][:, i], COLOURS[i]) for i in frames]
    following = np.abs(rows["following_error_deg"][:, frames]).max(axis=1, initial=0.0)
    errors = [
        Line(following, _GREY, 0.6),
        Line(rows["tracking_error_deg"], "#d55e00"),
        Line(rows["solve_error_deg"], "#0072b2"),
    ]
    kinds = [("solve", "#0072b2"), ("tracking", "#d55e00"), ("following, largest of a frame", _GREY)]
    return [
        Axes("angles [deg]: commanded (thin) and measured (broad)", angles, legend=names),
        _shares(rows, rig, frames, "demand_rate", "max_rate", "rates"),
        _shares(rows, rig, frames, "demand_acceleration", "max_acceleration", "accelerations"),
        Axes("errors [deg]", errors, logarithmic=True, legend=kinds),
    ]


def _shares(rows: Samples, rig: Rig | None, frames: list[int], field: str, limit: str, name: str) -> Axes:
    """Magnitudes in percent of each frame's own limit; of frames that have none nothing is drawn."""
    if rig is None:
        lines = [Line(np.abs(rows[field][:, i]), COLOURS[i]) for i in frames]
        return Axes(f"commanded {name} (the rig's limits are not known)", lines)
    most = {i: math.degrees(getattr(rig.frames[i], limit)) for i in frames}
    lines = [Line(100.0 * np.abs(rows[field][:, i]) / most[i], COLOURS[i]) for i in frames if 0.0 < most[i] < math.inf]
    without = ", ".join(FRAMES[i].value for i in frames if not 0.0 < most[i] < math.inf)
    return Axes(f"commanded {name} [% of the limit]" + (f"; no limit: {without}" if without else ""), lines, 100.0)


def drawing(time_s: Array, shown: Sequence[Axes], alarm_times: Sequence[Mark] = ()) -> str:
    """The plots, one below the other, over time (n,) [s]."""
    height = TOP + len(shown) * (HEIGHT + GAP) - GAP + BOTTOM
    end = max(float(time_s[-1]) if len(time_s) else 0.0, 1e-3)
    parts = [
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH:g} {height:g}" '
        f'width="{WIDTH:g}" height="{height:g}">'
    ]
    for number, axes in enumerate(shown):
        parts += _draw(axes, time_s, end, TOP + number * (HEIGHT + GAP))
    bottom = TOP + len(shown) * (HEIGHT + GAP) - GAP
    for tick in _ticks(0.0, end, 8):
        x = _x(tick, end)
        parts.append(f'<text x="{x:.2f}" y="{bottom + 10:.2f}" text-anchor="middle" {_STYLE}>{tick:g}</text>')
    parts.append(f'<text x="{LEFT - 8:g}" y="{bottom + 10:.2f}" text-anchor="end" {_STYLE}>time [s]</text>')
    for mark in alarm_times:
        if -_NEAR_S <= mark.time_s <= end + _NEAR_S:
            x = _x(min(max(mark.time_s, 0.0), end), end)
            parts.append(
                f'<path d="M{x:.2f} {TOP:g}V{bottom:.2f}" stroke="{_MARK}" stroke-width="0.7" stroke-dasharray="3 2"/>'
            )
            parts.append(
                f'<text x="{x:.2f}" y="{bottom + 21:.2f}" text-anchor="middle" font-family="DejaVu Sans Mono" '
                f'font-size="8" font-weight="bold" fill="{_MARK}">{escape(mark.letter)}</text>'
            )
    return "\n".join([*parts, "</svg>"])


def thinned(values: Array, columns: int = COLUMNS) -> tuple[Array, Array]:
    """(places (m,) in 0..1, values (m,)): of each column the smallest and the largest; nan where it has no number."""
    n = len(values)
    if n <= 2 * columns:
        return np.linspace(0.0, 1.0, n) if n > 1 else np.zeros(n), values
    edges = np.linspace(0, n, columns, endpoint=False).astype(np.int64)
    low, high = np.fmin.reduceat(values, edges), np.fmax.reduceat(values, edges)
    places = np.repeat((edges + 0.5 * (n / columns)) / n, 2)
    return places, np.column_stack([low, high]).ravel()


def _draw(axes: Axes, time_s: Array, end: float, top: float) -> list[str]:
    curves = [(line, *thinned(line.values)) for line in axes.lines]
    low, high = _range([values for _, _, values in curves], axes)
    parts = [
        f'<rect x="{LEFT:g}" y="{top:.2f}" width="{WIDTH - LEFT - RIGHT:.2f}" height="{HEIGHT:g}" '
        'fill="none" stroke="#888" stroke-width="0.6"/>',
        f'<text x="{LEFT:g}" y="{top - 4:.2f}" {_STYLE}>{escape(axes.title)}</text>',
        *_legend(axes, top),
    ]
    for tick in _ticks(low, high, _TICKS):
        y = _y(tick, low, high, top)
        label = f"1e{tick:g}" if axes.logarithmic else f"{tick:g}"
        parts.append(f'<path d="M{LEFT:g} {y:.2f}H{WIDTH - RIGHT:g}" stroke="#ddd" stroke-width="0.5"/>')
        parts.append(f'<text x="{LEFT - 4:g}" y="{y + 2.6:.2f}" text-anchor="end" {_STYLE}>{label}</text>')
    if axes.limit is not None:
        y = _y(axes.limit, low, high, top)
        parts.append(f'<path d="M{LEFT:g} {y:.2f}H{WIDTH - RIGHT:g}" stroke="{_MARK}" stroke-width="0.8"/>')
    n = len(time_s)
    for line, places, values in curves:
        shown = np.log10(np.where(values > 0.0, values, np.nan)) if axes.logarithmic else values
        at = np.interp(places * (n - 1), np.arange(n), time_s) if n else places
        path = _path(at, shown, end, low, high, top)
        dashes = f' stroke-dasharray="{line.dashes}"' if line.dashes else ""
        parts.append(
            f'<path d="{path}" fill="none" stroke="{line.colour}" stroke-width="{line.width:g}" '
            f'stroke-opacity="{line.opacity:g}" stroke-linejoin="round"{dashes}/>'
        )
    return parts


def _legend(axes: Axes, top: float) -> Iterator[str]:
    """The names of the curves, from the right."""
    x = WIDTH - RIGHT
    for name, colour in reversed(axes.legend):
        style = _STYLE.replace("#333", colour)
        yield f'<text x="{x:.2f}" y="{top - 4:.2f}" text-anchor="end" {style}>{escape(name)}</text>'
        x -= 4.55 * (len(name) + 2)


def _range(curves: Sequence[Array], axes: Axes) -> tuple[float, float]:
    """Of the axis: of all numbers, a little more, and the limit."""
    joined = np.concatenate(curves) if curves else np.empty(0)
    seen = joined[np.isfinite(joined)]
    if axes.logarithmic:
        seen = np.log10(seen[seen > 0.0])
        low, high = (float(np.floor(seen.min())), float(np.ceil(seen.max()))) if seen.size else (-6.0, 0.0)
        return max(low, min(_LOWEST, high - 2.0)) if high > low else low - 1.0, high
    if axes.limit is not None:
        return 0.0, 1.08 * max(axes.limit, float(seen.max()) if seen.size else 0.0)
    low, high = (float(seen.min()), float(seen.max())) if seen.size else (0.0, 1.0)
    margin = 0.05 * (high - low) or 1.0
    return low - margin, high + margin


def _path(time_s: Array, values: Array, end: float, low: float, high: float, top: float) -> str:
    x = LEFT + (WIDTH - LEFT - RIGHT) * time_s / end
    y = top + HEIGHT * (1.0 - (np.clip(values, low, high) - low) / (high - low))
    told, pen = [], False
    for at, height in zip(x.tolist(), y.tolist(), strict=True):
        if math.isfinite(height):
            told.append(f"{'L' if pen else 'M'}{at:.2f} {height:.2f}")
        pen = math.isfinite(height)
    return "".join(told) or "M0 0"


def _x(time_s: float, end: float) -> float:
    return LEFT + (WIDTH - LEFT - RIGHT) * time_s / end


def _y(value: float, low: float, high: float, top: float) -> float:
    return top + HEIGHT * (1.0 - (value - low) / (high - low))


def _ticks(low: float, high: float, most: int) -> list[float]:
    """Round numbers from low to high, at most about so many."""
    raw = (high - low) / most
    power = 10.0 ** math.floor(math.log10(raw))
    step = next(factor * power for factor in (1.0, 2.0, 5.0, 10.0) if factor * power >= raw * (1.0 - 1e-9))
    first = math.ceil(low / step - 1e-9)
    return [round(k * step, 12) + 0.0 for k in range(first, math.floor(high / step + 1e-9) + 1)]
