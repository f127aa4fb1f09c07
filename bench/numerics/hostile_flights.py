"""Flights made from frame paths of 18 hostile styles, each at a share of every limit: what the planner must not refuse.

    python -m bench.numerics.hostile_flights [--styles ride,sluggish] [--seeds 4] [--first 0] [--shares 0.5,0.8,0.95]
        [--json FILE]

A path of the frames is made first, scaled until each frame's largest rate or acceleration is that share of its limit,
so the flight is flyable by construction; the planner is told the flight alone. `--first` is the first seed, so that
flights can be tried on which nothing was tuned. Every answer is checked by `fullpose.verify`: an acceptance that it
contradicts is wrong.
"""

import argparse
import json
import math
import time
from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from bench.machine import machine
from fullpose.plan import PlanOptions, plan
from fullpose.rig import FrameLimits, Geometry, Rig
from fullpose.verify import payload_attitudes, verify

DEG = math.pi / 180.0
HZ = 500.0
Array = NDArray[np.float64]
Chance = np.random.Generator
Row = tuple[float, float, float, float]  # min, max [deg], rate [deg/s], acceleration [deg/s^2]
Limits = tuple[Row, ...]  # of base, outer, middle, inner
WIDE = (-np.inf, np.inf)
FREE: Limits = ((*WIDE, 200, 500), (*WIDE, 250, 800), (*WIDE, 300, 1200), (*WIDE, 600, 4000))
INNER: Row = (-60, 60, 600, 4000)
SLUGGISH2: Limits = ((*WIDE, 200, 3), (*WIDE, 250, 20), (*WIDE, 300, 1200), INNER)
NARROW: Limits = ((-300, 300, 200, 250), (-170, 170, 250, 400), (-120, 120, 300, 600), (-60, 60, 600, 2000))
TIGHT: Limits = ((-40, 40, 60, 100), (-50, 50, 60, 100), (-50, 50, 60, 100), (-45, 45, 60, 100))
MULTI: Limits = ((-400, 400, 200, 500), (-400, 400, 250, 800), (-400, 400, 300, 1200), (-720, 720, 600, 4000))


@dataclass(frozen=True)
class Flight:
    """A rig and a path (n, 4) [rad] at time (n,) [s] inside its limits."""

    rig: Rig
    time: Array
    path: Array


def _rig(name: str, chance: Chance, limits: Limits) -> Rig:
    geometry = chance.choice([Geometry.VERTICAL_4, Geometry.HORIZONTAL_4])
    frames = [
        FrameLimits(a * DEG, b * DEG, v * DEG, c * DEG, home=0.5 * (a + b) * DEG if np.isfinite(a + b) else 0.0)
        for a, b, v, c in limits
    ]
    return Rig(name, Geometry(geometry), (frames[0], frames[1], frames[2], frames[3]))


def _with(index: int, value: Row, base: Limits = FREE) -> Limits:
    rows = list(base)
    rows[index] = value
    return tuple(rows)


def _sines(chance: Chance, t: Array, count: int = 4, low: float = 0.05, high: float = 0.5) -> Array:
    waves = [
        chance.normal() * np.sin(2 * np.pi * chance.uniform(low, high) * t + chance.uniform(0, 2 * np.pi))
        for _ in range(count)
    ]
    return np.asarray(np.sum(waves, axis=0))


def _fit(t: Array, y: Array, limits: FrameLimits, share: float, place: float) -> Array:
    """y scaled to a share of the frame's limits, and put into its range."""
    v = np.diff(y) / np.diff(t)
    a = np.diff(v) / (0.5 * (t[2:] - t[:-2]))
    scale = share / max(np.abs(v).max() / limits.max_rate, np.abs(a).max() / limits.max_acceleration, 1e-12)
    scale = min(scale, 4.0 * np.pi / np.ptp(y))
    if np.isfinite(limits.max):
        scale = min(scale, 0.98 * (limits.max - limits.min) / np.ptp(y))
        y = y * scale
        low, high = limits.min - y.min(), limits.max - y.max()
        return np.asarray(y + low + (high - low) * place)
    return np.asarray(y * scale + 2 * np.pi * (place - 0.5))


def _all(rig: Rig, chance: Chance, t: Array, share: float) -> Array:
    return np.stack(
        [_fit(t, _sines(chance, t), frame, share, chance.uniform(0.02, 0.98)) for frame in rig.frames], axis=1
    )


def _from(limits: Callable[[Chance], Limits], seconds: float) -> Callable[[str, Chance, float], Flight]:
    def make(name: str, chance: Chance, share: float) -> Flight:
        rig = _rig(name, chance, limits(chance))
        t = np.arange(round(seconds * HZ) + 1) / HZ
        return Flight(rig, t, _all(rig, chance, t, share))

    return make


def _slow(frame: int, chance: Chance) -> Limits:
    """The usual rig with one slow frame."""
    _, _, rate, _ = FREE[frame]
    return _with(frame, (-np.inf, np.inf, rate, float(chance.choice([3.0, 5.0, 10.0, 20.0]))), _with(3, INNER))


def _ends_at(flight: Flight, frames: tuple[int, ...]) -> Flight:
    """The rig with ranges that end where the path does."""
    limits = list(flight.rig.frames)
    for i in frames:
        low, high = float(flight.path[:, i].min()), float(flight.path[:, i].max())
        limits[i] = replace(limits[i], min=low, max=high, home=0.5 * (low + high))
    return Flight(replace(flight.rig, frames=(limits[0], limits[1], limits[2], limits[3])), flight.time, flight.path)


def _least_ranges(name: str, chance: Chance, share: float) -> Flight:
    return _ends_at(_from(lambda _: FREE, 6.0)(name, chance, share), (0, 1, 2, 3))


def _smooth_step(s: Array) -> Array:
    s = np.clip(s, 0.0, 1.0)
    return np.asarray(s**3 * (10.0 + s * (6.0 * s - 15.0)))


def _ride(name: str, chance: Chance, share: float) -> Flight:
    """The outer frame comes to its limit and stays there for a while."""
    rig = _rig(name, chance, _with(1, (-70, 70, 250, 800)))
    t = np.arange(round(8.0 * HZ) + 1) / HZ
    path = _all(rig, chance, t, share)
    begin, end = np.sort(chance.uniform(1.0, 7.0, 2))
    y = _smooth_step((t - begin + 1.0) / 1.0) - _smooth_step((t - end) / 1.0)
    path[:, 1] = _fit(t, y + 1e-9 * t, replace(rig.frames[1], min=-np.inf, max=np.inf), share, 0.5)
    path[:, 1] += rig.frames[1].max - path[:, 1].max()
    return Flight(rig, t, path)


def _through(name: str, chance: Chance, share: float) -> Flight:
    """Outer at zero and middle at 90 deg at the same instant."""
    rig = _rig(name, chance, _with(3, INNER))
    t = np.arange(round(5.0 * HZ) + 1) / HZ
    path = _all(rig, chance, t, share)
    k = int(chance.uniform(0.3, 0.7) * len(t))
    path[:, 1] -= path[k, 1]
    path[:, 2] += np.sign(chance.normal()) * np.pi / 2 - path[k, 2]
    return Flight(rig, t, path)


def _needles(name: str, chance: Chance, share: float) -> Flight:
    """The middle frame goes to and fro through 90 deg."""
    rig = _rig(name, chance, _with(3, INNER))
    t = np.arange(round(6.0 * HZ) + 1) / HZ
    path = _all(rig, chance, t, share)
    path[:, 2] += np.pi / 2 - np.median(path[:, 2])
    return Flight(rig, t, path)


def _twins(name: str, chance: Chance, share: float) -> Flight:
    """The middle frame looks over 90 deg and back at once."""
    rig = _rig(name, chance, FREE)
    t = np.arange(round(5.0 * HZ) + 1) / HZ
    path = _all(rig, chance, t, share)
    path[:, 2] += np.pi / 2 - path[:, 2].max() + chance.uniform(0.2, 2.0) * DEG
    return Flight(rig, t, path)


def _level_switch(name: str, chance: Chance, share: float) -> Flight:
    """Level all the time: outer at zero, then middle at 90 deg while the outer turns."""
    rig = _rig(name, chance, _with(3, INNER))
    t = np.arange(round(4.0 * HZ) + 1) / HZ
    path = np.stack(
        [_fit(t, _sines(chance, t), frame, share, chance.uniform(0.3, 0.7)) for frame in rig.frames], axis=1
    )
    path[:, 1] = path[:, 2] = 0.0
    rise, turn = 1.0 - _smooth_step((t - 0.2) / 1.7), _smooth_step((t - 2.1) / 1.7)
    path[:, 2] = np.pi / 2 - _bounded(t, rise, rig.frames[2], share)
    path[:, 1] = _bounded(t, turn, rig.frames[1], share)
    return Flight(rig, t, path)


def _level_part(name: str, chance: Chance, share: float) -> Flight:
    """Level for a part of the time: outer at zero there."""
    rig = _rig(name, chance, _with(3, INNER))
    t = np.arange(round(6.0 * HZ) + 1) / HZ
    path = _all(rig, chance, t, share)
    path[:, 1] = _bounded(t, _smooth_step((t - 3.5) / 2.0), rig.frames[1], share)
    return Flight(rig, t, path)


def _bounded(t: Array, y: Array, limits: FrameLimits, share: float) -> Array:
    """y scaled to a share of the frame's limits, from where it is, by no more than a radian and a half."""
    scaled = _fit(t, y + 1e-12 * t, replace(limits, min=-np.inf, max=np.inf), share, 0.5)
    return np.asarray((y - y[0]) * min(1.5, np.ptp(scaled) / np.ptp(y)) + y[0] * 0.0)


def _steps(name: str, chance: Chance, share: float) -> Flight:
    """Every frame from rest to rest, one after the other and together."""
    rig = _rig(name, chance, _with(3, INNER))
    t = np.arange(round(6.0 * HZ) + 1) / HZ
    columns = []
    for frame in rig.frames:
        y = sum(
            chance.normal() * _smooth_step((t - chance.uniform(0.0, 4.0)) / chance.uniform(0.8, 2.0)) for _ in range(4)
        )
        columns.append(_fit(t, np.asarray(y), frame, share, chance.uniform(0.1, 0.9)))
    return Flight(rig, t, np.stack(columns, axis=1))


def _offset(chance: Chance) -> Limits:
    low = chance.uniform(-900, 700, 4)
    return tuple((a, a + w, v, c) for a, w, (_, _, v, c) in zip(low, (500, 300, 200, 150), FREE, strict=True))


STYLES: dict[str, Callable[[str, Chance, float], Flight]] = {
    "free": _from(lambda _: FREE, 6.0),
    "usual": _from(lambda _: _with(3, INNER), 6.0),
    "narrow": _from(lambda _: NARROW, 6.0),
    "tight": _from(lambda _: TIGHT, 6.0),
    "multi": _from(lambda _: MULTI, 6.0),
    "offset": _from(_offset, 6.0),
    "sluggish": _from(lambda chance: _slow(0, chance), 12.0),
    "sluggish2": _from(lambda _: SLUGGISH2, 12.0),
    "slow outer": _from(lambda chance: _slow(1, chance), 12.0),
    "slow middle": _from(lambda chance: _slow(2, chance), 12.0),
    "least ranges": _least_ranges,
    "ride": _ride,
    "through": _through,
    "needles": _needles,
    "twins": _twins,
    "level switch": _level_switch,
    "level part": _level_part,
    "steps": _steps,
}  # fmt: skip


def flight(style: str, seed: int, share: float) -> Flight | None:
    """A flight of a style; None where its path is not inside the limits after all."""
    chance = np.random.default_rng([list(STYLES).index(style), seed, round(100 * share)])
    made = STYLES[style](f"{style}_{seed}_{share}", chance, share)
    return made if not verify(made.time, made.path, made.rig).violations else None


def tried(style: str, seed: int, share: float, made: Flight) -> dict[str, Any]:
    """What the planner says of a flight; a refusal and a wrong acceptance are printed."""
    attitude = payload_attitudes(made.rig, made.path)
    begin = time.process_time()
    answer = plan(made.time, attitude, made.rig, options=PlanOptions(best_effort=False))
    spent = time.process_time() - begin
    flown = answer.verdict.feasible
    checked = verify(made.time, answer.solution.angles, made.rig, attitude)
    wrong = flown and (bool(checked.violations) or not checked.max_error < 1e-9 * DEG)
    if wrong or not flown:
        said = "WRONG" if wrong else "refused"
        print(f"{style} {seed} {share}: {said} {spent:.2f} s {answer.verdict.blocking}", flush=True)
    return {"style": style, "seed": seed, "share": share, "flown": flown, "wrong": wrong, "cpu_s": spent}


def summary(name: str, rows: list[dict[str, Any]]) -> str:
    """A line: how many were flown, and the processor time of those and of the refused."""
    flown, refused = ([row["cpu_s"] for row in rows if row["flown"] == is_flown] for is_flown in (True, False))
    wrong = sum(bool(row["wrong"]) for row in rows)
    times = [f"{what} {np.median(of):.2f} s" for what, of in (("flown", flown), ("refused", refused)) if of]
    return f"{name:14s} flown {len(flown)} of {len(rows)}, wrong {wrong}, median {', '.join(times)}"


def main() -> None:
    """Print a line a style, and the refusals."""
    arguments = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    arguments.add_argument("--styles", default=",".join(STYLES))
    arguments.add_argument("--seeds", type=int, default=4)
    arguments.add_argument("--first", type=int, default=0)
    arguments.add_argument("--shares", default="0.5,0.8,0.95")
    arguments.add_argument("--json", type=Path, default=None)
    given = arguments.parse_args()
    print(machine())
    rows: list[dict[str, Any]] = []
    for style in given.styles.split(","):
        of = []
        for seed in range(given.first, given.first + given.seeds):
            for share in map(float, given.shares.split(",")):
                made = flight(style, seed, share)
                if made is None:
                    print(f"{style} {seed} {share}: not flyable after all, left out", flush=True)
                else:
                    of.append(tried(style, seed, share, made))
        print(summary(style, of), flush=True)
        rows += of
    print(summary("all", rows))
    if given.json is not None:
        given.json.write_text(json.dumps({"machine": machine(), "flights": rows}, indent=1), encoding="utf-8")


if __name__ == "__main__":
    main()
