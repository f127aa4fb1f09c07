"""From a node path to a path for the whole flight: smooth, exact, refined window by window."""

from dataclasses import dataclass

import numpy as np

from fullpose._jit import kernel
from fullpose._typing import Array, Counts, Integers, Progress
from fullpose.rig import Rig
from fullpose.trajectory.constraints import rig_limits
from fullpose.trajectory.curve import closest_all, hold_locked, smoothed, spline_rows, spline_slopes
from fullpose.trajectory.options import PlanOptions
from fullpose.trajectory.shortest_path import NodePath
from fullpose.trajectory.sqp import MET, OVERRUN, Refined, refine, worst

STIFFNESS = (5.0, 0.3, 0.0)  # of the smoothing of a node path, tried in turn until the path does not jump
JUMP = 4.0  # times the rate limit between two samples: no curve any more


@dataclass(frozen=True)
class Path:
    """A path for the whole flight: angles (n, 4) [rad], the windows that stayed outside the limits, iterations (n,)."""

    angles: Array
    failures: tuple[Refined, ...]  # `sample` counted from the flight's beginning
    iterations: Counts


def stage_samples(time: Array, stage: float) -> Integers:
    """The samples nearest to every `stage` seconds, first and last included."""
    n = len(time)
    count = max(1, round(float(time[-1] - time[0]) / stage)) if n > 1 else 1
    if count >= n - 1:
        return np.arange(n)
    at = np.searchsorted(time, np.linspace(time[0], time[-1], count + 1))
    return np.unique(np.r_[0, np.clip(at, 0, n - 1), n - 1])


def smooth_curve(
    time: Array, attitude: Array, rig: Rig, samples: Integers, node_path: NodePath, start: Array | None
) -> Array:
    """The exact path (n, 4) [rad] next to the smoothed node path, whose stages are at `samples`."""
    knots = time[samples]
    points = node_path.angles.copy()
    if start is not None:
        points[0] = start
    d = np.empty((len(time), 4))
    if len(samples) < 2:
        d[:] = points[0]
        closest_all(rig.axes, rig.geometry.horizontal, attitude, d)
        hold_locked(rig.geometry.horizontal, rig.axes, attitude, rig.position_min, rig.position_max, d)
        return d
    spacing = float(np.diff(knots).mean())
    fastest = JUMP * np.minimum(rig.max_rate, 100.0)
    for stiffness in STIFFNESS:
        y = smoothed(points, stiffness * min(1.0, (0.05 / spacing) ** 4))
        if start is not None:
            y[0] = start
        spline_rows(knots, y, spline_slopes(knots, y), time, d)
        closest_all(rig.axes, rig.geometry.horizontal, attitude, d)
        hold_locked(rig.geometry.horizontal, rig.axes, attitude, rig.position_min, rig.position_max, d)
        if not jumps(time, d, fastest):
            break
    if start is not None:
        d[0] = start
    return d


@kernel
def jumps(time: Array, d: Array, fastest: Array) -> bool:
    """Whether any frame of d (n, 4) [rad] is anywhere faster than `fastest` (4,) [rad/s]."""
    for k in range(1, time.shape[0]):
        for i in range(4):
            if abs(d[k, i] - d[k - 1, i]) > fastest[i] * (time[k] - time[k - 1]):
                return True
    return False


def refine_path(
    time: Array, attitude: Array, angles: Array, rig: Rig, options: PlanOptions, *,
    start: bool = False, start_rate: Array | None = None, progress: Progress | None = None,
) -> Path:  # fmt: skip
    """Refine an exact path (n, 4) [rad] in place, window by window where it is long. `progress` in samples."""
    n = len(time)
    d = angles  # in place: an hour's path is not held twice
    iterations = np.zeros(n, np.int32)
    failures: list[Refined] = []
    begin = 0
    while True:
        end = (
            n
            if time[-1] - time[begin] <= 1.5 * options.window
            else int(np.searchsorted(time, time[begin] + options.window))
        )
        following = n if end == n else int(np.searchsorted(time, time[end - 1] - options.overlap))
        result = _window(time, attitude, d, rig, options, begin, end, following, start, start_rate)
        if result.over > MET and begin > 0:  # what went before may have left no way: take more of it
            wider = int(np.searchsorted(time, time[begin] - options.window))
            again = _window(time, attitude, d, rig, options, wider, end, following, start, start_rate)
            if again.over < result.over:
                result, begin = again, wider
        d[begin:end] = result.angles
        iterations[begin:end] = result.iterations
        if result.over > MET:
            failures.append(
                Refined(
                    result.angles[:0], result.over, begin + result.sample, result.frame, result.limit, result.iterations
                )
            )
        if progress is not None:
            progress(end, n)
        if end == n:
            return Path(d, tuple(failures), iterations)
        begin = max(following, begin + 1)


def _window(
    time: Array, attitude: Array, d: Array, rig: Rig, options: PlanOptions, begin: int, end: int, following: int,
    start: bool, start_rate: Array | None,
) -> Refined:  # fmt: skip
    n = len(time)
    part = slice(begin, end)
    return refine(
        time[part], attitude[part], d[part], rig, options, pinned=(begin > 0, end < n),
        start=start and begin == 0, start_rate=start_rate if begin == 0 else None,
        ends=(begin == 0, end == n), judged=None if end == n else following - begin,
        missed_cost=OVERRUN,
    )  # fmt: skip


def overrun(time: Array, angles: Array, rig: Rig) -> tuple[float, int, int, int]:
    """(overrun as a share, sample, frame, limit) of the whole path's worst sample."""
    return worst(time, angles, rig_limits(rig))
