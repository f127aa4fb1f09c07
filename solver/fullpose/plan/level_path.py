"""Paths of a flight that is level throughout (mathematics, section 14): sin d2 cos d3 = 0 at every sample.

A level attitude is a yaw and a roll. On the upright sheets of its solutions the outer frame stands at 0 or 180 deg and
base and middle share the yaw; on the edge sheets the middle stands at +-90 deg and outer and inner share the roll. They
meet in corners, where both stand so, which is the singularity: there a path may change from one to another, at rest in
what it lets go of. With u the middle's angle and w what the outer has turned from its corner, every frame is linear in
u and w on both, so for a corner and the times of the changes the path with the most room is one linear programme.
"""

import itertools
import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from scipy import sparse

from fullpose._typing import Array
from fullpose.charts import TURN, vertical_views
from fullpose.rig import Rig
from fullpose.trajectory.clamped_spline import clamped_basis
from fullpose.trajectory.problem import Problem
from fullpose.trajectory.qp import Matrices, Matrix, Status
from fullpose.verify import attitude_errors, payload_attitudes

LEVEL = 1e-9  # a sine of pitch below which there is none
QUARTER = 0.25 * TURN
DEGREE, KNOT = 5, 0.06  # of the splines of u and w; [s]
ROWS = 0.01  # [s] between the samples that have rows
CHANGES = (0.25, 0.5)  # [s] between the times that are tried of one change, and of two
ENOUGH = -0.02  # of the limits: a path with this much room is taken, the best one otherwise
LONGEST = 60.0  # [s] of a flight that is looked at
RIGID = 1e-6  # of the coefficients' squares beside the room
EXACT = 1e-9  # [rad] of a corner's formula
UPRIGHT, EDGE = False, True
PATTERNS = ((UPRIGHT,), (EDGE,), (UPRIGHT, EDGE), (EDGE, UPRIGHT), (UPRIGHT, EDGE, UPRIGHT), (EDGE, UPRIGHT, EDGE))


@dataclass(frozen=True)
class Corner:
    """Where u is `middle` and w zero, and the frames around it: d = fixed (n, 4) + slope (4, 2) (u, w) [rad]."""

    middle: float
    fixed: Array
    slope: Array


def is_level(problem: Problem) -> bool:
    """Whether the flight is level at every sample, and brief enough to be looked at."""
    time = problem.time
    if len(time) < 3 or time[-1] - time[0] > LONGEST:
        return False
    return bool(np.abs(vertical_views(problem.attitude, problem.rig.geometry.horizontal)[:, 0, 1]).max() < LEVEL)


def level_path(problem: Problem) -> Array | None:
    """The exact path (n, 4) [rad] with the most room of those tried; None where none has any."""
    best: tuple[float, Array] | None = None
    sheets = _Sheets(problem)
    found_corners = [(corner, sheets.limits(corner)) for corner in corners(problem)]
    for pattern in PATTERNS:
        for corner, limits in found_corners:
            for changes in _changes(problem.time, len(pattern) - 1):
                found = sheets.best(corner, limits, pattern, changes)
                if found is not None and (best is None or found[0] < best[0]):
                    best = found
                if best is not None and best[0] <= ENOUGH:
                    return best[1]
    return best[1] if best is not None and best[0] <= 0.0 else None


def corners(problem: Problem) -> Iterator[Corner]:
    """The corners of a level flight, each with the frames in the turns next to the middle of their ranges."""
    rig, attitude = problem.rig, problem.attitude
    yaw, roll = _yaw_and_roll(attitude, rig.geometry.horizontal)
    for outer, middle in itertools.product((0.0, 0.5 * TURN), (QUARTER, -QUARTER)):
        turned = outer > 0.0
        fixed = np.zeros((len(yaw), 4))
        fixed[:, 0] = yaw - outer if turned else yaw
        fixed[:, 1] = outer
        fixed[:, 3] = roll - outer
        for inner in (1.0, -1.0):
            slope = np.array([[1.0 if turned else -1.0, 0.0], [0.0, 1.0], [1.0, 0.0], [0.0, inner]])
            on_edge = fixed + slope @ np.array([middle, 0.3])
            error, _ = attitude_errors(payload_attitudes(rig, on_edge), attitude)
            if error.max() < EXACT:
                yield Corner(middle, fixed + _centred(rig, fixed), slope)


def _yaw_and_roll(attitude: Array, horizontal: bool) -> tuple[Array, Array]:
    """(d1 + d3, d4) [rad], unwrapped, of level attitudes (n, 3, 3) where the outer frame is at 0."""
    V = vertical_views(attitude, horizontal)
    return np.unwrap(np.arctan2(-V[:, 0, 2], V[:, 0, 0])), np.unwrap(np.arctan2(-V[:, 2, 1], V[:, 1, 1]))


def _centred(rig: Rig, fixed: Array) -> Array:
    """(4,) whole turns that bring each frame next to the middle of its range, or to where it is at home."""
    return np.asarray(TURN * np.rint((rig.home - fixed.mean(axis=0)) / TURN))


def _changes(time: Array, count: int) -> Iterator[tuple[float, ...]]:
    """Times [s] of so many changes, in order."""
    if count == 0:
        yield ()
        return
    step = CHANGES[count - 1]
    inside = np.arange(float(time[0]) + step, float(time[-1]) - 0.5 * step, step).tolist()
    yield from itertools.combinations(inside, count)


class _Sheets:
    """The programmes of one flight."""

    def __init__(self, problem: Problem) -> None:
        self._problem = problem
        time = problem.time
        self._knots, self._basis = clamped_basis(time, KNOT, DEGREE)
        step = max(1, round(ROWS / float(np.median(np.diff(time)))))
        self._at = np.unique(np.r_[1 : len(time) - 1 : step, len(time) - 2])

    def best(
        self, corner: Corner, limits: tuple[Matrix, Array], pattern: tuple[bool, ...], changes: tuple[float, ...]
    ) -> tuple[float, Array] | None:
        """(how far beyond the limits, as a share, negative inside; the path (n, 4)) ; None: there is none."""
        problem, count = self._problem, self._basis.shape[1]
        low, high = self._still(corner, pattern, changes)
        rows, room = limits
        n = 2 * count
        A, b = self._start(corner)
        answer = problem.solver(
            Matrices(
                P=sparse.csc_matrix(sparse.identity(n + 1) * RIGID),
                q=np.append(np.zeros(n), 1.0),
                G=rows,
                h=room,
                A=A,
                b=b,
                lower=np.append(low, -1.0),
                upper=np.append(high, 1e3),
            )
        )
        if answer.status is not Status.SOLVED:
            return None
        free = self._basis @ answer.x[:n].reshape(2, count).T
        return float(answer.x[n]), corner.fixed + free @ corner.slope.T

    def _still(self, corner: Corner, pattern: tuple[bool, ...], changes: tuple[float, ...]) -> tuple[Array, Array]:
        """(lowest, highest) of the coefficients of u and of w: they stand where the sheet gives them no freedom."""
        count = self._basis.shape[1]
        low, high = np.full((2, count), -1e3), np.full((2, count), 1e3)
        begin, end = self._knots[:count], self._knots[DEGREE + 1 :]  # of each function's support
        time = self._problem.time
        ends = (float(time[0]), *changes, float(time[-1]))
        for sheet, first, last in zip(pattern, ends[:-1], ends[1:], strict=True):
            touched = (begin < last) & (end > first)
            which, value = (0, corner.middle) if sheet is EDGE else (1, 0.0)
            low[which, touched] = high[which, touched] = value
        return low.ravel(), high.ravel()

    def _start(self, corner: Corner) -> tuple[Matrix | None, Array | None]:
        """Equalities that keep the first pose."""
        start = self._problem.start
        if start is None:
            return None, None
        first = sparse.block_diag([self._basis[:1], self._basis[:1]])
        values = np.array([start[2], start[1] - corner.fixed[0, 1]])
        return sparse.hstack([first, sparse.csc_matrix((2, 1))], format="csc"), values

    def limits(self, corner: Corner) -> tuple[Matrix, Array]:
        """(rows, room): rows (c, slack) <= room, shares of every limit at the samples that have rows."""
        rig, time, k = self._problem.rig, self._problem.time, self._at
        before, after = time[k] - time[k - 1], time[k + 1] - time[k]
        basis, fixed = self._basis, corner.fixed

        def differences(values: Matrix) -> list[Matrix]:
            rate = sparse.diags(1.0 / before) @ (values[k] - values[k - 1])
            bend = sparse.diags(1.0 / after) @ (values[k + 1] - values[k]) - rate
            return [values[k], rate, sparse.diags(2.0 / (before + after)) @ bend]

        kinds, drift = differences(basis), differences(fixed)
        rows, room = [], []
        for i in range(4):
            for kind, (low, high) in enumerate(_bounds(rig, i)):
                if not math.isfinite(high):
                    continue
                row = sparse.hstack([corner.slope[i, 0] * kinds[kind], corner.slope[i, 1] * kinds[kind]])
                size = 0.5 * (high - low)
                for sign, bound in ((1.0, high), (-1.0, -low)):
                    rows.append(sign * row / size)
                    room.append((bound - sign * drift[kind][:, i]) / size)
        bounds = np.concatenate(room)
        slack = sparse.csc_matrix(-np.ones((len(bounds), 1)))
        return sparse.hstack([sparse.vstack(rows), slack], format="csc"), bounds


def _bounds(rig: Rig, i: int) -> tuple[tuple[float, float], ...]:
    """(low, high) of a frame's position, rate and acceleration."""
    rate, acceleration = float(rig.max_rate[i]), float(rig.max_acceleration[i])
    return (float(rig.position_min[i]), float(rig.position_max[i])), (-rate, rate), (-acceleration, acceleration)
