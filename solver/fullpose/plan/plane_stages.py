"""A flight cut into the stages of the search in its plane: each needle lies just before the end of one."""

import itertools
from dataclasses import dataclass

import numpy as np

from fullpose._typing import Integers
from fullpose.trajectory.needles import CLEAR, Needles
from fullpose.trajectory.plane_motion import NO_NEEDLE, Stage
from fullpose.trajectory.problem import Problem

FINE = 0.02  # [s] between the samples that a stage looks at
AIMS, AHEAD = 4, 6.0  # needles that are aimed at, and how many stages ahead at most


@dataclass(frozen=True)
class FlightStage:
    """A stage in samples of the flight: where it begins and the fine samples after that, up to its end."""

    begin: int
    fine: Integers
    stage: Stage


def flight_stages(problem: Problem, found: Needles, length: float) -> list[FlightStage]:
    """The flight cut into stages of about `length` [s]; each needle lies just before the end of one."""
    time = problem.time
    step = max(1, round(FINE / float(np.median(np.diff(time)))))
    n = len(time)
    closed = np.zeros(n, np.bool_)  # samples not looked at
    ends = []
    for t in found.time:
        low, high = np.searchsorted(time, (t - CLEAR, t + CLEAR))
        closed[low:high] = True
        if high < n:
            ends.append(int(high))
    stages = []
    begin = 0
    for end in [*ends, n - 1]:
        if end <= begin:
            continue
        count = max(1, round(float(time[end] - time[begin]) / length))
        cuts = np.unique(np.linspace(begin, end, count + 1).round().astype(int))
        for a, b in itertools.pairwise(cuts):
            fine = np.unique(np.r_[np.arange(b, a, -step), b])
            if len(fine) > 1:
                fine = fine[~closed[fine] | (fine == b)]
            stages.append(FlightStage(int(a), fine, _stage(problem, found, int(a), fine, length)))
        begin = end
    return stages


def _stage(problem: Problem, found: Needles, begin: int, fine: Integers, length: float) -> Stage:
    time = problem.time
    inside = (found.time > time[begin]) & (found.time < time[fine[-1]])
    needle = float(found.time[inside][-1] - time[begin]) if inside.any() else NO_NEEDLE
    first = int(np.searchsorted(found.time, time[begin] + needle if inside.any() else time[fine[-1]]))
    last = min(first + AIMS, int(np.searchsorted(found.time, time[begin] + AHEAD * length, side="right")))
    part = slice(first, max(last, first + 1 if inside.any() else first))
    return Stage(
        time[fine] - time[begin], np.ascontiguousarray(problem.attitude[fine]), needle, found.time[part] - time[begin],
        found.base[part].copy(),
    )  # fmt: skip
