"""Where the search in the plane of a flight may begin: poses, and rates of the base."""

import itertools
import math
from collections.abc import Iterator

import numpy as np

from fullpose._typing import Array
from fullpose.charts import TURN, base_chart
from fullpose.rig import Rig
from fullpose.trajectory.needles import Needles
from fullpose.trajectory.plane_motion import base_for
from fullpose.trajectory.plane_search import States, empty_states
from fullpose.trajectory.problem import Problem

STEP = math.radians(4.0)  # [rad] between the base angles that a free start is tried from
RATES = 9  # of the base that it is tried with
LED = (-1.0, -0.5, 0.0, 0.5, 1.0)  # rates that a frame that leads begins with, as shares of a second's change
LED_AHEAD = 0.01  # [s] over which those are taken
NEEDLES = 4  # that it may run straight at
HALF = 0.5 * TURN
MULTIPLES = range(-4, 5)  # half turns between two of them


def first_states(problem: Problem, found: Needles, acceleration: float, leading: list[int]) -> States:
    """States at the first sample: the start asked for, or a grid of base angles; several rates of the base each."""
    rig, attitude = problem.rig, problem.attitude[0]
    fastest = min(float(rig.max_rate[0]), 2.0 * acceleration)
    if problem.start is not None and problem.start_rate is not None:
        return _states([(problem.start, float(problem.start_rate[0]))])
    poses = _first_poses(attitude, rig) if problem.start is None else problem.start[None]
    rates = np.linspace(-fastest, fastest, RATES)
    rows = [(pose, rate) for pose in poses for rate in rates]
    rows += [(pose, rate) for pose in poses for rate in _led_rates(problem, pose, leading, fastest)]
    if problem.start is not None:
        rows += [(problem.start, rate) for rate in _toward(problem, found, float(problem.start[0]), fastest)]
    else:
        rows += [
            (pose, rate) for angle, rate in _lines(problem, found, rates, fastest)
            for pose in _poses_at(attitude, rig, angle)
        ]  # fmt: skip
    return _states(rows)


def _states(rows: list[tuple[Array, float]]) -> States:
    """States of (pose (4,) [rad], rate of the base [rad/s])."""
    states = empty_states(len(rows))
    for k, (pose, rate) in enumerate(rows):
        states.base[k] = pose[0], rate, 1.0 if math.cos(pose[2]) >= 0.0 else -1.0
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


def _toward(problem: Problem, found: Needles, angle: float, fastest: float) -> list[float]:
    """Rates of the base [rad/s] with which it runs straight at one of the first needles."""
    rates = []
    for t, base in _soon(problem, found):
        low = base + HALF * math.floor((angle - base) / HALF)
        rates += [rate for near in (low, low + HALF) if abs(rate := (near - angle) / t) <= fastest]
    return rates


def _lines(problem: Problem, found: Needles, rates: Array, fastest: float) -> list[tuple[float, float]]:
    """(angle, rate) of the base that runs straight through one of the first needles at one of the rates, or through
    two."""
    soon = list(_soon(problem, found))
    lines = [(base - rate * t + half, rate) for t, base in soon for rate in rates for half in (0.0, HALF)]
    for (t1, base1), (t2, base2) in itertools.pairwise(soon):
        for multiple in MULTIPLES:
            rate = (base2 + multiple * HALF - base1) / (t2 - t1)
            if abs(rate) <= fastest:
                lines += [(base1 - rate * t1 + half, rate) for half in (0.0, HALF)]
    return lines


def _soon(problem: Problem, found: Needles) -> Iterator[tuple[float, float]]:
    """(time from the beginning, base angle) of the first needles."""
    begin = float(problem.time[0])
    for t, base in zip(found.time[:NEEDLES].tolist(), found.base[:NEEDLES].tolist(), strict=True):
        if t > begin:
            yield t - begin, base


def _first_poses(attitude: Array, rig: Rig) -> Array:
    """Exact poses (m, 4) [rad] on a grid of base angles, inside the ranges, in every turn that they leave."""
    count = round(TURN / STEP)
    poses = [pose for k in range(count) for pose in _poses_at(attitude, rig, -0.5 * TURN + k * STEP)]
    return np.array(poses).reshape(-1, 4)


def _poses_at(attitude: Array, rig: Rig, angle: float) -> list[Array]:
    """The exact poses (4,) [rad] with a base angle up to whole turns, inside the ranges, in every turn of them."""
    low, high = rig.position_min, rig.position_max
    poses = []
    d = np.empty(4)
    for branch in (1.0, -1.0):
        base_chart(rig.geometry.horizontal, attitude, angle, branch, d)
        choices: list[list[float]] = []
        for i in range(4):
            if not np.isfinite(high[i]):
                choices.append([0.0])
                continue
            first, last = math.ceil((low[i] - d[i]) / TURN), math.floor((high[i] - d[i]) / TURN)
            choices.append([TURN * j for j in range(first, last + 1)])
        poses += [d + np.array(each) for each in itertools.product(*choices)]
    return poses
