"""The exact pose nearest to a given one: where a flight starts."""

import numpy as np

from fullpose._jit import inner, kernel
from fullpose._typing import Array
from fullpose.bounds import EXACT, limited_code
from fullpose.charts import TURN, base_chart, inner_chart, nearest, project
from fullpose.kinematics import four_axis_pose, rotation_error
from fullpose.limits import HOME, MAX, MIN, WEIGHT, limit_table
from fullpose.rig import Rig
from fullpose.step import box_least_squares

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
def copy(source: Array, target: Array) -> None:
    """target <- source, (4,): a slice assignment takes Numba far longer to compile."""
    for i in range(4):
        target[i] = source[i]


@inner
def chart_pose(
    table: Array, horizontal: bool, C: Array, chart: int, parameter: float, reference: Array, d: Array
) -> tuple[float, float]:
    """d <- the pose of a chart (0, 1: base chart, branch +1, -1; 2, 3: inner chart) nearest to `reference` [rad].

    Returns (how far outside the position limits [rad], weighted squared distance).
    """
    branch = 1.0 if chart % 2 == 0 else -1.0
    if chart < 2:
        base_chart(horizontal, C, parameter, branch, d)
    else:
        inner_chart(horizontal, C, parameter, branch, d)
    outside = 0.0
    cost = 0.0
    for i in range(4):
        d[i] = turn_inside(d[i], reference[i], table[MIN, i], table[MAX, i])
        outside = max(outside, max(table[MIN, i] - d[i], d[i] - table[MAX, i]))
        cost += table[WEIGHT, i] * (d[i] - reference[i]) ** 2
    return outside, cost


@kernel
def search_start(table: Array, horizontal: bool, C: Array, reference: Array, d: Array) -> int:
    """d <- the exact pose for C nearest to `reference` inside the position limits; returns -1.

    Both charts and both their branches are searched on a grid, then by halving steps. Where no exact pose is inside
    the limits: d <- a pose inside them with the least attitude error near by; returns the frame that keeps it away.
    """
    pose = np.empty(4)
    project(horizontal, C, reference, d)
    outside = 0.0
    cost = 0.0
    for i in range(4):
        outside = max(outside, max(table[MIN, i] - d[i], d[i] - table[MAX, i]))
        cost += table[WEIGHT, i] * (d[i] - reference[i]) ** 2
    if outside <= 0.0 and cost < 1e-16:
        return -1
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
                copy(pose, d)
    if best_chart >= 0:
        step = TURN / GRID
        for _ in range(HALVINGS):
            for sign in (-1.0, 1.0):
                parameter = best_parameter + sign * step
                out, c = chart_pose(table, horizontal, C, best_chart, parameter, reference, pose)
                if out < outside or (out <= outside and c < cost):
                    outside, cost = out, c
                    best_parameter = parameter
                    copy(pose, d)
                    break
            else:
                step *= 0.5
    if outside <= 0.0:
        return -1
    # No exact pose: into the limits, then downhill in the attitude error.
    worst = 0
    for i in range(4):
        if max(table[MIN, i] - d[i], d[i] - table[MAX, i]) >= outside:
            worst = i
        d[i] = min(max(d[i], table[MIN, i]), table[MAX, i])
    F = np.empty((3, 3))
    J = np.empty((3, 4))
    A = np.empty((4, 5))
    n = np.empty(4)
    e = np.empty(3)
    s = np.empty(4)
    work = np.empty((4, 4))
    for _ in range(DESCENTS):
        four_axis_pose(horizontal, d, F, J, n)
        if rotation_error(C, F, e) < 1e-12:
            break
        for i in range(4):
            work[0, i] = table[MIN, i] - d[i]
            work[1, i] = table[MAX, i] - d[i]
            work[2, i] = DESCENT_DAMPING
            work[3, i] = 0.0
        box_least_squares(J, e, work[2], work[3], work[0], work[1], s, A)
        for i in range(4):
            step = min(max(s[i], -LONGEST_DESCENT), LONGEST_DESCENT)
            d[i] = min(max(d[i] + step, table[MIN, i]), table[MAX, i])
    return worst


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
