"""Paths by the search in the plane of time and one frame's angle (mathematics, section 14).

The search decides the course and the inertia of a slow frame together, and runs exactly through the needles or gates
that it chooses, which no path of nodes does. It is wide but not complete, so it proves nothing.
"""

import math
from dataclasses import dataclass

import numpy as np

from fullpose._typing import Array, Progress
from fullpose.charts import TURN
from fullpose.limits import limit_table
from fullpose.plan.plane_stages import FlightStage, flight_stages
from fullpose.plan.plane_starts import first_states
from fullpose.rig import Rig
from fullpose.trajectory.base_curve import mended, smooth_base
from fullpose.trajectory.frame_chart import BASE, INNER, branch_of, frames_of
from fullpose.trajectory.needles import Needles, aims_of
from fullpose.trajectory.plane_motion import NO_NEEDLE, Controls, Plane, angle_at
from fullpose.trajectory.plane_search import States, empty_states, empty_table, expand, first_of
from fullpose.trajectory.problem import Problem

STEP = math.radians(12.0)  # [rad] the base goes by from rest in a stage at its full acceleration
SHORTEST, LONGEST = 0.12, 0.8  # [s] of a stage
CELL = math.radians(4.0)  # [rad] of the own frame's angle; of a slow frame that the others follow, what it goes by
VIOLATION_COST, GATE_COST = 30.0, 300.0  # [1/s] of a limit exceeded e times; a gate missed is so for a moment only
FOLLOWED = 0.35  # [s] of a stage in the plane of such a frame
UNLIMITED = math.radians(2000.0)  # [rad/s^2] of a frame without an acceleration limit
SHARES = np.linspace(-0.95, 0.95, 7)  # of the own frame's acceleration
LED = np.array([-0.95, -0.5, 0.0, 0.5, 0.95, 2.0])  # of the acceleration of a frame that leads (`led_by`)
SLOPES = np.array([-1.0, 0.0, 1.0])  # of the rate that a stage can change, beside the mean one through a needle
HALF = 0.5 * TURN
BASE_KNOT = 0.06  # [s] of the base's spline where another frame was searched for
KNOTS = 3.0  # of the own frame's spline a stage
SLOW = math.radians(60.0)  # [rad/s^2] a frame of no more is slow
MOST_NEEDLES = 20.0  # a second, above which the flight is level or noisy, and has none worth the name


@dataclass(frozen=True)
class PlaneBreadth:
    """How widely to search: states a stage, the stages' length and the rates' cells beside the usual ones, whose plane
    it is, and whether slow frames other than the base lead in the base's."""

    states: int
    stages: float
    cells: float
    slow_lead: bool = False
    frame: int = BASE


def slow_frames(rig: Rig, base: bool = False) -> list[int]:
    """The frames whose acceleration is slow, the base's only if asked for."""
    return [i for i in range(0 if base else 1, 4) if rig.max_acceleration[i] <= SLOW]


def needled(problem: Problem, found: Needles) -> bool:
    """Whether the flight has few enough needles to be looked at."""
    return len(found.time) <= MOST_NEEDLES * float(problem.time[-1] - problem.time[0])


def plane_path(problem: Problem, found: Needles, breadth: PlaneBreadth, progress: Progress | None) -> Array | None:
    """An exact path (n, 4) [rad], continuous, the limits exceeded least; None where none can begin or end.

    found: the needles of the flight.
    """
    time, rig, frame = problem.time, problem.rig, breadth.frame
    if not needled(problem, found):
        return None
    aims = aims_of(found, time, problem.attitude, rig, frame)
    acceleration = float(min(rig.max_acceleration[frame], UNLIMITED))
    usual = min(max(math.sqrt(STEP / acceleration), SHORTEST), LONGEST if aims.exact else FOLLOWED)
    length = breadth.stages * usual
    leading = slow_frames(rig) if breadth.slow_lead else []
    stages = flight_stages(problem, aims, length)
    cells = _rate_cells(rig, [frame, *leading], breadth.cells * length)
    plane = Plane(
        rig.geometry.horizontal, limit_table(rig), frame, not np.isfinite(rig.position_max[frame]),
        CELL if aims.exact else min(CELL, float(cells[frame]) * length), _counted(rig), cells,
        VIOLATION_COST if aims.exact else GATE_COST,
    )  # fmt: skip
    kept = [first_states(problem, aims, frame, acceleration, leading)]
    table = empty_table()
    for number, each in enumerate(stages):
        if not len(kept[-1].cost):
            return None
        out = empty_states(breadth.states)
        duration = min(float(each.stage.at[-1]), length)
        count = expand(plane, each.stage, kept[-1], _controls(acceleration, leading, duration), table, out)
        kept.append(first_of(out, count))
        if progress is not None:
            progress(number + 1, len(stages))
    if not len(kept[-1].cost):
        return None
    return mended(problem, found, _traced(problem, found, frame, stages, kept, length / KNOTS))


def _counted(rig: Rig) -> Array:
    """(4,) 1 for frames of several turns whose range ends."""
    wide = np.isfinite(rig.position_max) & (rig.position_max - rig.position_min >= TURN)
    return wide.astype(float)


def _rate_cells(rig: Rig, frames: list[int], length: float) -> Array:
    """(4,) [rad/s] a quarter of what `length` [s] can change the rates by, of the frames that count."""
    cells = np.full(4, math.inf)
    for i in frames:
        cells[i] = 0.25 * length * min(rig.max_acceleration[i], UNLIMITED)
    return cells


def _controls(acceleration: float, leading: list[int], duration: float) -> Controls:
    """What is tried in a stage of `duration` [s]; acceleration [rad/s^2] of the own frame."""
    frame = np.repeat(np.array(leading, np.int64), len(LED))
    return Controls(SHARES * acceleration, frame, np.tile(LED, len(leading)), SLOPES * acceleration * duration)


def _traced(
    problem: Problem, found: Needles, frame: int, stages: list[FlightStage], kept: list[States], knot: float
) -> Array:  # fmt: skip
    """The cheapest course back, made smooth, at every sample of the flight: (n, 4) [rad]."""
    order = [int(np.argmin(kept[-1].cost))]
    for states in reversed(kept[1:]):
        order.append(int(states.parent[order[-1]]))
    order.reverse()
    time = problem.time
    own = np.empty(len(time))
    first = kept[0].pose[order[0], 0]
    own[0] = first[frame]
    pins: list[tuple[float, float]] = []
    for number, each in enumerate(stages):
        angle, rate, _ = kept[number].own[order[number]]
        second, third, needle = kept[number + 1].motion[order[number + 1]]
        part = slice(each.begin + 1, int(each.fine[-1]) + 1)
        at = time[part] - time[each.begin]
        own[part] = angle + at * (rate + at * (0.5 * second + at * third / 6.0))
        if needle < NO_NEEDLE:
            pins.append((float(time[each.begin] + needle), angle_at(angle, rate, second, third, needle)))
    horizontal, everywhere = problem.rig.geometry.horizontal, np.arange(len(time))
    d = np.empty((len(time), 4))
    if frame in (BASE, INNER):
        branch = _branches(time, kept[0].own[order[0], 2], pins)
        own = smooth_base(time, everywhere, own, _with_start(problem, frame, pins), knot)
        frames_of(horizontal, time, problem.attitude, frame, own, branch, first, d)
        return d
    # As the search saw it: a path that only nearly touches a gate goes through it from one of those samples to the
    # next, and leaves it in a jerk. So the base's angle there is what is made smooth.
    seen = np.unique(np.concatenate([[0], *(each.fine for each in stages)]))
    at = np.empty((len(seen), 4))
    attitude = np.ascontiguousarray(problem.attitude[seen])
    frames_of(horizontal, time[seen], attitude, frame, own[seen], np.ones(len(seen)), first, at)
    pins = _crossed(time[seen], found, at)
    base = smooth_base(time, seen, at[:, 0], _with_start(problem, BASE, pins), BASE_KNOT)
    branch = _branches(time, branch_of(horizontal, BASE, at[0]), pins)
    frames_of(horizontal, time, problem.attitude, BASE, base, branch, first, d)
    return d


def _branches(time: Array, first: float, pins: list[tuple[float, float]]) -> Array:
    """(n,) the branch at time (n,) [s]: `first`, and another after each of the pins."""
    return np.asarray(first * (-1.0) ** np.searchsorted([t for t, _ in pins], time))


def _with_start(problem: Problem, frame: int, pins: list[tuple[float, float]]) -> list[tuple[float, float]]:
    """The pins, and the first pose where it is asked for."""
    return pins if problem.start is None else [(float(problem.time[0]), float(problem.start[frame])), *pins]


def _crossed(time: Array, found: Needles, d: Array) -> list[tuple[float, float]]:
    """(time, angle) of the base's needles at which a path d (n, 4) [rad] at time (n,) [s] changes its branch."""
    upright = np.cos(d[:, 2]) >= 0.0
    pins = []
    for t, angle in zip(found.time.tolist(), found.base.tolist(), strict=True):
        k = int(np.searchsorted(time, t))
        if 0 < k < len(time) and upright[k] != upright[k - 1]:
            pins.append((t, angle + HALF * round((float(d[k, 0]) - angle) / HALF)))
    return pins
