"""Paths by the search in the plane of time and base angle (mathematics, section 14).

The search decides the course and the inertia of a slow base together, and runs exactly through the needles that it
chooses, which no path of nodes does. It is wide but not complete, so it proves nothing.
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
from fullpose.trajectory.base_curve import frames_of_base, mended, smooth_base
from fullpose.trajectory.needles import needles
from fullpose.trajectory.plane_motion import NO_NEEDLE, Controls, Plane, base_at
from fullpose.trajectory.plane_search import States, empty_states, empty_table, expand, first_of
from fullpose.trajectory.problem import Problem

STEP = math.radians(12.0)  # [rad] the base goes by from rest in a stage at its full acceleration
SHORTEST, LONGEST = 0.12, 0.8  # [s] of a stage
UNLIMITED = math.radians(2000.0)  # [rad/s^2] of a base without an acceleration limit
SHARES = np.linspace(-0.95, 0.95, 7)  # of the base's acceleration
LED = np.array([-0.95, -0.5, 0.0, 0.5, 0.95, 2.0])  # of the acceleration of a frame that leads (`led_by`)
SLOPES = np.array([-1.0, 0.0, 1.0])  # of the rate that a stage can change, beside the mean one through a needle
KNOTS = 3.0  # of the base's spline a stage
SLOW = math.radians(60.0)  # [rad/s^2] a frame of no more is slow
MOST_NEEDLES = 20.0  # a second, above which the flight is level or noisy, and has none worth the name


@dataclass(frozen=True)
class PlaneBreadth:
    """How widely to search: states a stage, the stages' length and the rates' cells beside the usual ones, and whether
    slow frames other than the base lead, too."""

    states: int
    stages: float
    cells: float
    slow_lead: bool = False


def slow_frames(rig: Rig) -> list[int]:
    """The frames but the base whose acceleration is slow."""
    return [i for i in (1, 2, 3) if rig.max_acceleration[i] <= SLOW]


def plane_path(problem: Problem, breadth: PlaneBreadth, progress: Progress | None) -> Array | None:
    """An exact path (n, 4) [rad], continuous, the limits exceeded least; None where none can begin or end."""
    time, rig = problem.time, problem.rig
    found = needles(time, problem.attitude, rig.geometry.horizontal)
    if len(found.time) > MOST_NEEDLES * float(time[-1] - time[0]):
        return None
    acceleration = float(min(rig.max_acceleration[0], UNLIMITED))
    length = breadth.stages * min(max(math.sqrt(STEP / acceleration), SHORTEST), LONGEST)
    leading = slow_frames(rig) if breadth.slow_lead else []
    stages = flight_stages(problem, found, length)
    plane = Plane(
        rig.geometry.horizontal, limit_table(rig), not np.isfinite(rig.position_max[0]), _counted(rig),
        _rate_cells(rig, leading, breadth.cells * length),
    )  # fmt: skip
    kept = [first_states(problem, found, acceleration, leading)]
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
    return mended(problem, found, _traced(problem, stages, kept, length / KNOTS))


def _counted(rig: Rig) -> Array:
    """(4,) 1 for frames of several turns whose range ends."""
    wide = np.isfinite(rig.position_max) & (rig.position_max - rig.position_min >= TURN)
    return wide.astype(float)


def _rate_cells(rig: Rig, leading: list[int], length: float) -> Array:
    """(4,) [rad/s] a quarter of what `length` [s] can change the rates by, of the base and the frames that lead."""
    cells = np.full(4, math.inf)
    for i in (0, *leading):
        cells[i] = 0.25 * length * min(rig.max_acceleration[i], UNLIMITED)
    return cells


def _controls(acceleration: float, leading: list[int], duration: float) -> Controls:
    """What is tried in a stage of `duration` [s]; acceleration [rad/s^2] of the base."""
    frame = np.repeat(np.array(leading, np.int64), len(LED))
    return Controls(SHARES * acceleration, frame, np.tile(LED, len(leading)), SLOPES * acceleration * duration)


def _traced(problem: Problem, stages: list[FlightStage], kept: list[States], knot: float) -> Array:
    """The cheapest course back, made smooth, at every sample of the flight: (n, 4) [rad]."""
    order = [int(np.argmin(kept[-1].cost))]
    for states in reversed(kept[1:]):
        order.append(int(states.parent[order[-1]]))
    order.reverse()
    time = problem.time
    base = np.empty(len(time))
    first = kept[0].pose[order[0], 0]
    base[0] = first[0]
    pins: list[tuple[float, float]] = []
    for number, each in enumerate(stages):
        angle, rate, _ = kept[number].base[order[number]]
        second, third, needle = kept[number + 1].motion[order[number + 1]]
        part = slice(each.begin + 1, int(each.fine[-1]) + 1)
        at = time[part] - time[each.begin]
        base[part] = angle + at * (rate + at * (0.5 * second + at * third / 6.0))
        if needle < NO_NEEDLE:
            pins.append((float(time[each.begin] + needle), base_at(angle, rate, second, third, needle)))
    fixed = pins if problem.start is None else [(float(time[0]), float(first[0])), *pins]
    branch = kept[0].base[order[0], 2] * (-1.0) ** np.searchsorted([t for t, _ in pins], time)
    d = np.empty((len(time), 4))
    smooth = smooth_base(time, base, fixed, knot)
    frames_of_base(problem.rig.geometry.horizontal, problem.attitude, smooth, branch, first, d)
    return d
