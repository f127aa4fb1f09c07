"""The exact pose nearest to a given one: where a flight starts."""

import numpy as np

from fullpose._jit import inner, kernel
from fullpose._typing import Array
from fullpose.bounds import EXACT, limited_code
from fullpose.charts import TURN, base_chart, inner_chart, nearest, project
from fullpose.errors import MethodError
from fullpose.kinematics import four_axis_pose, rotation_error
from fullpose.least_squares import LeastSquares, box_least_squares
from fullpose.limits import HOME, MAX, MIN, WEIGHT, limit_table
from fullpose.rig import Rig

GRID = 720  # samples of each chart; half a degree
HALVINGS = 40  # of the grid's step: far below rounding
DESCENTS = 60  # Gauss-Newton steps where no exact pose is inside the limits
LONGEST_DESCENT = 0.2  # [rad] a frame in one of them
DESCENT_DAMPING = 1e-9


@inner
def turn_inside(angle: float, reference: float, low: float, high: float) -> float:
    """The angle, plus whole turns, nearest to `reference` within [low, high]; else the one nearest to the range."""
    angle = nearest(angle, reference)
    while angle > high and angle - TURN >= low - (angle - high):
        angle -= TURN
    while angle < low and angle + TURN <= high + (low - angle):
        angle += TURN
    return angle


@inner
def misfit(table: Array, reference: Array, d: Array) -> tuple[float, float]:
    """(how far d (4,) lies outside the position limits [rad], its weighted squared distance from `reference`)."""
    outside = 0.0
    cost = 0.0
    for i in range(4):
        outside = max(outside, max(table[MIN, i] - d[i], d[i] - table[MAX, i]))
        cost += table[WEIGHT, i] * (d[i] - reference[i]) ** 2
    return outside, cost


@inner
def chart_pose(
    table: Array, horizontal: bool, C: Array, chart: int, parameter: float, reference: Array, d: Array
) -> tuple[float, float]:
    """d <- the pose of a chart (0, 1: base chart, branch +1, -1; 2, 3: inner chart) nearest to `reference` [rad].

    Returns its `misfit`.
    """
    branch = 1.0 if chart % 2 == 0 else -1.0
    if chart < 2:
        base_chart(horizontal, C, parameter, branch, d)
    else:
        inner_chart(horizontal, C, parameter, branch, d)
    for i in range(4):
        d[i] = turn_inside(d[i], reference[i], table[MIN, i], table[MAX, i])
    return misfit(table, reference, d)


@inner
def search_charts(table: Array, horizontal: bool, C: Array, reference: Array, pose: Array, d: Array) -> float:
    """d <- the exact pose of all charts that is least outside the position limits, of those the nearest, if it beats d.

    Both charts and both their branches are searched on a grid, then by halving steps. Returns how far it lies outside
    [rad]. pose (4,) is room to work in.
    """
    outside, cost = misfit(table, reference, d)
    best_chart = -1
    best_parameter = 0.0
    for chart in range(4):
        kept = 0 if chart < 2 else 3
        for k in range(GRID):
            parameter = reference[kept] + TURN * k / GRID
            out, c = chart_pose(table, horizontal, C, chart, parameter, reference, pose)
            if out < outside or (out <= outside and c < cost):
                outside, cost = out, c
                best_chart, best_parameter = chart, parameter
                for i in range(4):
                    d[i] = pose[i]
    if best_chart < 0:
        return outside
    step = TURN / GRID
    for _ in range(HALVINGS):
        for sign in (-1.0, 1.0):
            parameter = best_parameter + sign * step
            out, c = chart_pose(table, horizontal, C, best_chart, parameter, reference, pose)
            if out < outside or (out <= outside and c < cost):
                outside, cost = out, c
                best_parameter = parameter
                for i in range(4):
                    d[i] = pose[i]
                break
        else:
            step *= 0.5
    return outside


@kernel
def descend(table: Array, horizontal: bool, C: Array, d: Array) -> None:
    """d <- a pose inside the position limits with the least attitude error near by. d (4,) inside them."""
    F = np.empty((3, 3))
    J = np.empty((3, 4))
    n = np.empty(4)
    s = np.empty(4)
    A = np.empty((4, 5))
    problem = LeastSquares(J, np.empty(3), np.full(4, DESCENT_DAMPING), np.zeros(4), np.empty(4), np.empty(4))
    for _ in range(DESCENTS):
        four_axis_pose(horizontal, d, F, J, n)
        if rotation_error(C, F, problem.e) < 1e-12:
            break
        for i in range(4):
            problem.lo[i] = table[MIN, i] - d[i]
            problem.hi[i] = table[MAX, i] - d[i]
        box_least_squares(problem, s, A)
        for i in range(4):
            step = min(max(s[i], -LONGEST_DESCENT), LONGEST_DESCENT)
            d[i] = min(max(d[i] + step, table[MIN, i]), table[MAX, i])


@kernel
def search_start(table: Array, horizontal: bool, C: Array, reference: Array, d: Array) -> int:
    """d <- the exact pose for C nearest to `reference` inside the position limits; returns -1.

    Where no exact pose is inside the limits: d <- a pose inside them with the least attitude error near by; returns the
    frame that keeps it away.
    """
    project(horizontal, C, reference, d)
    outside, cost = misfit(table, reference, d)
    if outside > 0.0 or cost >= 1e-16:
        outside = search_charts(table, horizontal, C, reference, np.empty(4), d)
    if outside <= 0.0:
        return -1
    farthest = 0
    for i in range(4):
        if max(table[MIN, i] - d[i], d[i] - table[MAX, i]) >= outside:
            farthest = i
        d[i] = min(max(d[i], table[MIN, i]), table[MAX, i])
    descend(table, horizontal, C, d)
    return farthest


def require_fourth_axis(name: str, rig: Rig) -> None:
    """Raises `MethodError` where the rig has no redundant axis; `name` is the method's."""
    if not rig.geometry.redundant:
        raise MethodError(f"{name} needs the fourth axis; {rig.name} is {rig.geometry.value}: use three_axis")


def require_no_jerk_limits(name: str, rig: Rig) -> None:
    """Raises `MethodError` where the rig has jerk limits: the method `name` claims limits, and keeps none of jerk."""
    if rig.jerk_limited:
        raise MethodError(
            f"{name} does not keep jerk limits, and {rig.name} has them: use plan, or a rig without max_jerk_deg_s3"
        )


def start_pose(rig: Rig, attitude: Array, near: Array | None) -> tuple[Array, int]:
    """The exact pose for `attitude` (3, 3) nearest to `near` (4,) [rad], or to the rig's home where None.

    Nearest in the rig's weights, inside its position limits. Returns (pose (4,) [rad], `EXACT`), or, where no exact
    pose is inside them, the pose that comes closest and the `limited_code` of the frame that is in the way.
    Only for four-axis rigs.
    """
    table = limit_table(rig)
    reference = table[HOME].copy() if near is None else np.asarray(near, float).copy()
    pose = np.empty(4)
    frame = search_start(table, rig.geometry.horizontal, np.ascontiguousarray(attitude), reference, pose)
    return pose, EXACT if frame < 0 else limited_code(int(frame), 0)
