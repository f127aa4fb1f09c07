"""Where the search in the plane of a frame may begin: poses, and rates of the frame."""

import itertools
import math
from collections.abc import Iterator

import numpy as np

from fullpose._typing import Array
from fullpose.charts import TURN
from fullpose.rig import Rig
from fullpose.trajectory.frame_chart import BASE, INNER, base_angles, base_for, branch_of, pose_of
from fullpose.trajectory.needles import Aims
from fullpose.trajectory.plane_search import States, empty_states
from fullpose.trajectory.problem import Problem

STEP = math.radians(4.0)  # [rad] between the angles that a free start is tried from
RATES = 9  # of the own frame that it is tried with
LED = (-1.0, -0.5, 0.0, 0.5, 1.0)  # rates that a frame that leads begins with, as shares of a second's change
LED_AHEAD = 0.01  # [s] over which those are taken
SOON = 4  # of what may be aimed at: it may run straight there
HALF = 0.5 * TURN
MULTIPLES = range(-4, 5)  # half turns between two of them


def first_states(problem: Problem, aims: Aims, frame: int, acceleration: float, leading: list[int]) -> States:
    """States at the first sample: the start asked for, or a grid of the frame's angles; several rates of it each."""
    rig, attitude = problem.rig, problem.attitude[0]
    fastest = min(float(rig.max_rate[frame]), 2.0 * acceleration)
    if problem.start is not None and problem.start_rate is not None:
        return _states([(problem.start, float(problem.start_rate[frame]))], rig, frame)
    poses = _first_poses(attitude, rig, frame) if problem.start is None else problem.start[None]
    rates = np.linspace(-fastest, fastest, RATES)
    rows = [(pose, rate) for pose in poses for rate in rates]
    rows += [(pose, rate) for pose in poses for rate in _led_rates(problem, pose, leading, fastest)]
    if problem.start is not None:
        rows += [(problem.start, rate) for rate in _toward(problem, aims, float(problem.start[frame]), fastest)]
    else:
        rows += [
            (pose, rate) for angle, rate in _lines(problem, aims, rates, fastest)
            for pose in _poses_at(attitude, rig, frame, angle)
        ]  # fmt: skip
    return _states(rows, rig, frame)


def _states(rows: list[tuple[Array, float]], rig: Rig, frame: int) -> States:
    """States of (pose (4,) [rad], rate of the frame [rad/s])."""
    states = empty_states(len(rows))
    for k, (pose, rate) in enumerate(rows):
        states.own[k] = pose[frame], rate, branch_of(rig.geometry.horizontal, frame, pose)
        states.pose[k, 0] = states.pose[k, 1] = pose
    states.cost[:] = 0.0
    return states


def _led_rates(problem: Problem, pose: Array, leading: list[int], fastest: float) -> list[float]:
    """Rates of the base [rad/s] with which frames that lead begin at a few rates that they can brake in a second."""
    time, rig = problem.time, problem.rig
    k = min(int(np.searchsorted(time, time[0] + LED_AHEAD)), len(time) - 1)
    ahead = float(time[k] - time[0])
    rates = []
    for i in leading:
        for share in LED:
            there = pose[i] + share * rig.max_acceleration[i] * ahead
            base = base_for(rig.geometry.horizontal, problem.attitude[k], i, float(there), float(pose[0]))
            if abs(base - pose[0]) <= fastest * ahead:
                rates.append(float(base - pose[0]) / ahead)
    return rates


def _toward(problem: Problem, aims: Aims, angle: float, fastest: float) -> list[float]:
    """Rates of the frame [rad/s] with which it runs straight at one of the first aims."""
    rates = []
    for t, there in _soon(problem, aims):
        low = there + HALF * math.floor((angle - there) / HALF)
        rates += [rate for near in (low, low + HALF) if abs(rate := (near - angle) / t) <= fastest]
    return rates


def _lines(problem: Problem, aims: Aims, rates: Array, fastest: float) -> list[tuple[float, float]]:
    """(angle, rate) of the frame that runs straight through one of the first aims at one of the rates, or through
    two."""
    soon = list(_soon(problem, aims))
    lines = [(there - rate * t + half, rate) for t, there in soon for rate in rates for half in (0.0, HALF)]
    for (t1, first), (t2, second) in itertools.combinations(soon, 2):
        for multiple in MULTIPLES if t2 > t1 else ():
            rate = (second + multiple * HALF - first) / (t2 - t1)
            if abs(rate) <= fastest:
                lines += [(first - rate * t1 + half, rate) for half in (0.0, HALF)]
    return lines


def _soon(problem: Problem, aims: Aims) -> Iterator[tuple[float, float]]:
    """(time from the beginning, angle) of the first aims."""
    begin = float(problem.time[0])
    for t, angle in zip(aims.time[:SOON].tolist(), aims.angle[:SOON].tolist(), strict=True):
        if t > begin:
            yield t - begin, angle


def _first_poses(attitude: Array, rig: Rig, frame: int) -> Array:
    """Exact poses (m, 4) [rad] on a grid of the frame's angles, inside the ranges, in every turn that they leave."""
    count = round(TURN / STEP)
    poses = [pose for k in range(count) for pose in _poses_at(attitude, rig, frame, -0.5 * TURN + k * STEP)]
    return np.array(poses).reshape(-1, 4)


def _poses_at(attitude: Array, rig: Rig, frame: int, angle: float) -> list[Array]:
    """The exact poses (4,) [rad] with an angle of the frame up to turns, inside the ranges, in every turn of them."""
    low, high = rig.position_min, rig.position_max
    horizontal = rig.geometry.horizontal
    bases = (0.0, 0.0)
    if frame not in (BASE, INNER):
        first, second, exists = base_angles(horizontal, attitude, frame, angle)
        bases = (first, second)
        if not exists:
            return []
    poses = []
    d = np.empty(4)
    for branch, base in zip((1.0, -1.0), bases, strict=True):
        pose_of(horizontal, attitude, frame, angle, branch, base, d)
        choices: list[list[float]] = []
        for i in range(4):
            if not np.isfinite(high[i]):
                choices.append([0.0])
                continue
            lowest, highest = math.ceil((low[i] - d[i]) / TURN), math.floor((high[i] - d[i]) / TURN)
            choices.append([TURN * j for j in range(lowest, highest + 1)])
        poses += [d + np.array(each) for each in itertools.product(*choices)]
    return poses
