"""From a node path to a path for the whole flight: smooth, exact, refined window by window."""

from dataclasses import dataclass

import numpy as np

from fullpose._jit import kernel
from fullpose._typing import Array, Counts, Integers, Progress
from fullpose.bounds import MET
from fullpose.trajectory.constraints import LimitViolation
from fullpose.trajectory.curve import closest_all, hold_locked, smoothed, spline_rows, spline_slopes
from fullpose.trajectory.problem import Problem
from fullpose.trajectory.shortest_path import NodePath
from fullpose.trajectory.sqp import VIOLATION_COST, Boundary, Refined, refine

STIFFNESS = (5.0, 0.3, 0.0)  # of the smoothing of a node path, tried in turn until the path does not jump
JUMP = 4.0  # times the rate limit between two samples: no curve any more


@dataclass(frozen=True)
class Path:
    """A path for the whole flight: angles (n, 4) [rad], the windows that stayed outside the limits, iterations (n,)."""

    angles: Array
    failures: tuple[LimitViolation, ...]  # `sample` counted from the flight's beginning
    iterations: Counts


def stage_samples(time: Array, stage: float) -> Integers:
    """The samples nearest to every `stage` seconds, first and last included."""
    n = len(time)
    count = max(1, round(float(time[-1] - time[0]) / stage)) if n > 1 else 1
    if count >= n - 1:
        return np.arange(n)
    at = np.searchsorted(time, np.linspace(time[0], time[-1], count + 1))
    return np.unique(np.r_[0, np.clip(at, 0, n - 1), n - 1])


def smooth_curve(problem: Problem, samples: Integers, node_path: NodePath) -> Array:
    """The exact path (n, 4) [rad] next to the smoothed node path, whose stages are at `samples`."""
    time, rig, start = problem.time, problem.rig, problem.start
    knots = time[samples]
    points = node_path.angles.copy()
    if start is not None:
        points[0] = start
    d = np.empty((len(time), 4))
    if len(samples) < 2:
        d[:] = points[0]
        _put_on_solutions(problem, d)
        return d
    spacing = float(np.diff(knots).mean())
    fastest = JUMP * np.minimum(rig.max_rate, 100.0)
    for stiffness in STIFFNESS:
        y = smoothed(points, stiffness * min(1.0, (0.05 / spacing) ** 4))
        if start is not None:
            y[0] = start
        spline_rows(knots, y, spline_slopes(knots, y), time, d)
        _put_on_solutions(problem, d)
        if not jumps(time, d, fastest):
            break
    if start is not None:
        d[0] = start
    return d


def _put_on_solutions(problem: Problem, d: Array) -> None:
    """d (n, 4) [rad] <- the exact poses next to it, in place; locked frames in the middle of their ranges."""
    rig, attitude = problem.rig, problem.attitude
    closest_all(rig.axes, rig.geometry.horizontal, attitude, d)
    hold_locked(rig.geometry.horizontal, rig.axes, attitude, rig.position_min, rig.position_max, d)


@kernel
def jumps(time: Array, d: Array, fastest: Array) -> bool:
    """Whether any frame of d (n, 4) [rad] is anywhere faster than `fastest` (4,) [rad/s]."""
    for k in range(1, time.shape[0]):
        for i in range(4):
            if abs(d[k, i] - d[k - 1, i]) > fastest[i] * (time[k] - time[k - 1]):
                return True
    return False


def refine_path(problem: Problem, angles: Array, progress: Progress | None = None) -> Path:
    """Refine an exact path (n, 4) [rad] in place, window by window where it is long. `progress` in samples."""
    time, options = problem.time, problem.options
    n = len(time)
    d = angles  # in place: an hour's path is not held twice
    iterations = np.zeros(n, np.int32)
    failures: list[LimitViolation] = []
    begin = 0
    while True:
        last = time[-1] - time[begin] <= 1.5 * options.window
        end = n if last else int(np.searchsorted(time, time[begin] + options.window))
        following = n if end == n else int(np.searchsorted(time, time[end - 1] - options.overlap))
        result = _window(problem, d, begin, end, following)
        if result.violation.share > MET and begin > 0:  # what went before may have left no way: take more of it
            wider = int(np.searchsorted(time, time[begin] - options.window))
            again = _window(problem, d, wider, end, following)
            if again.violation.share < result.violation.share:
                result, begin = again, wider
        d[begin:end] = result.angles
        iterations[begin:end] = result.iterations
        if result.violation.share > MET:
            failures.append(result.violation._replace(sample=begin + result.violation.sample))
        if progress is not None:
            progress(end, n)
        if end == n:
            return Path(d, tuple(failures), iterations)
        begin = max(following, begin + 1)


def _window(problem: Problem, d: Array, begin: int, end: int, following: int) -> Refined:
    """Samples begin..end (half-open) refined, joined to the one before; those from `following` on come again."""
    n = len(problem)
    part = problem.part(begin, end)
    first, last = begin == 0, end == n
    boundary = Boundary((not first, not last), (first, last), part.start is not None, part.start_rate)
    return refine(part, d[begin:end], boundary, None if last else following - begin, VIOLATION_COST)
