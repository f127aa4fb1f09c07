"""A flight cut into the stages of the search in its plane: each needle lies just before the end of one."""

import itertools
from dataclasses import dataclass

import numpy as np

from fullpose._typing import Integers
from fullpose.trajectory.needles import CLEAR, Aims
from fullpose.trajectory.plane_motion import NO_NEEDLE, Stage
from fullpose.trajectory.problem import Problem

FINE = 0.02  # [s] between the samples that a stage looks at
# Of what may be aimed at, how many at once, and how many stages ahead at most: needles; gates, of two sides each.
NEEDLES, GATES = (4, 6.0), (8, 9.0)


@dataclass(frozen=True)
class FlightStage:
    """A stage in samples of the flight: where it begins and the fine samples after that, up to its end."""

    begin: int
    fine: Integers
    stage: Stage


def flight_stages(problem: Problem, aims: Aims, length: float) -> list[FlightStage]:
    """The flight cut into stages of about `length` [s]; a needle that must be met lies just before the end of one."""
    time = problem.time
    step = max(1, round(FINE / float(np.median(np.diff(time)))))
    n = len(time)
    closed = np.zeros(n, np.bool_)  # samples not looked at
    ends = []
    for t in aims.time if aims.exact else ():
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
            stages.append(FlightStage(int(a), fine, _stage(problem, aims, int(a), fine, length)))
        begin = end
    return stages


def _stage(problem: Problem, aims: Aims, begin: int, fine: Integers, length: float) -> Stage:
    time = problem.time
    inside = (aims.time > time[begin]) & (aims.time < time[fine[-1]]) & aims.exact
    needle = float(aims.time[inside][-1] - time[begin]) if inside.any() else NO_NEEDLE
    first = int(np.searchsorted(aims.time, time[begin] + needle if inside.any() else time[fine[-1]]))
    most, ahead = NEEDLES if aims.exact else GATES
    last = min(first + most, int(np.searchsorted(aims.time, time[begin] + ahead * length, side="right")))
    part = slice(first, max(last, first + 1 if inside.any() else first))
    return Stage(
        time[fine] - time[begin], np.ascontiguousarray(problem.attitude[fine]), needle, aims.time[part] - time[begin],
        aims.angle[part].copy(), aims.bend[part].copy(),
    )  # fmt: skip
