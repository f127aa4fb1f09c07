"""The answer to a flight that cannot be flown: the least uniform tolerance, and the least squared error within it.

All frames are free (mathematics, section 13). A brief flight is looked at in one piece; of a long one that an exact
path leads through but for some stretches, those stretches, joined to the exact path with value, slope and bend; else
piece after piece. What is found is inside every limit; that nothing smaller exists is not proved.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from fullpose._typing import Array, Codes, Progress
from fullpose.bounds import MET
from fullpose.limits import limit_table
from fullpose.methods.start_pose import start_pose
from fullpose.plan.active_limits import active_limits
from fullpose.plan.exact_again import exact_again
from fullpose.plan.fallback import EXACT_ERROR
from fullpose.plan.follow import follow
from fullpose.plan.tolerance_search import Heard, Solved, least_squares, search_stretch
from fullpose.trajectory.constraints import exceeded, largest_violation, rig_limits
from fullpose.trajectory.problem import Problem
from fullpose.trajectory.tolerance_mesh import End
from fullpose.verify import attitude_errors, payload_attitudes

BRIEF = 30.0  # [s] of a stretch that is looked at in one piece
PIECE, DECIDED = 20.0, 15.0  # [s] of a longer one, and of them what is kept
PADDING = 2.0  # [s] of the exact path given up on each side of a place outside the limits
APART = 8  # samples of the exact path at least between two stretches
BEND_KEPT = 0.99  # of a bend that is joined to: it may be at its limit, the join need not be


@dataclass(frozen=True)
class LeastTolerance:
    """angles (n, 4) [rad] inside the limits, limited (n,) codes, the tolerance [rad]: their largest attitude error."""

    angles: Array
    limited: Codes
    tolerance: float


def least_tolerance(problem: Problem, paths: Sequence[Array], progress: Progress | None = None) -> LeastTolerance:
    """The least tolerance found for a flight; begins from `paths` (n, 4) [rad] too, the first of
    which is exact but for stretches outside the limits where `problem` is long.

    The start is kept, where the problem has one. progress(done, total), in samples, may raise `CancelledError`.
    """
    time = problem.time
    n = len(time)
    if n < 2:
        return _alone(problem, paths)

    def heard() -> None:
        if progress is not None:
            progress(n - 1, n)

    brief = time[-1] - time[0] <= BRIEF
    angles = _mended(problem, paths[0], heard) if paths and not brief else None
    if angles is None:
        angles = _in_pieces(problem, paths, heard)
    if angles is None or largest_violation(time, angles, rig_limits(problem.rig)).share > MET:
        angles = _following(problem, paths)
    path, error = exact_again(problem, angles)
    limited = active_limits(time, problem.attitude, path, problem.rig, error > EXACT_ERROR)
    return LeastTolerance(path, limited, float(error.max()))


def _alone(problem: Problem, paths: Sequence[Array]) -> LeastTolerance:
    """A flight of one sample with no exact pose inside the ranges: the pose in them that comes closest.

    A three-axis rig's is its Euler angles, each as far as its range goes.
    """
    rig = problem.rig
    if rig.geometry.redundant:
        x = start_pose(rig, problem.attitude[0], problem.start)[0][None]
    else:
        x = np.clip(paths[0], rig.position_min, rig.position_max)
    error = float(attitude_errors(payload_attitudes(rig, x), problem.attitude)[0][0])
    missed = np.array([error > EXACT_ERROR])
    return LeastTolerance(x, active_limits(problem.time, problem.attitude, x, rig, missed), error)


def _following(problem: Problem, paths: Sequence[Array]) -> Array:
    """A path inside every limit after the first of `paths`, or at home: where nothing else is found."""
    target = paths[0] if paths else np.repeat(problem.rig.home[None], len(problem), axis=0)
    x = np.empty_like(target)
    follow(limit_table(problem.rig), problem.time, target, x)
    return x


def _mended(problem: Problem, exact: Array, heard: Heard) -> Array | None:
    """`exact` (n, 4) [rad] with the stretches around the places outside the limits solved anew; None: not so."""
    time = problem.time
    n = len(time)
    solved: list[tuple[int, Solved]] = []
    for begin, end in _stretches(problem, exact):
        if time[end - 1] - time[begin] > BRIEF:
            return None
        part = problem.part(begin, end)
        ends = (
            _start_of(part) or (joined(time, exact, begin) if begin > 0 else None),
            (joined(time, exact, end - 1) if end < n else None),
        )
        found = search_stretch(part, ends, [exact[begin:end]], heard)
        if found is None:
            return None
        solved.append((begin, found))
    tolerance = max((found.tolerance for _, found in solved), default=0.0)
    x = exact.copy()
    for begin, found in solved:
        heard()
        x[begin : begin + len(found.problem)] = least_squares(found, tolerance).angles
    return x


def _stretches(problem: Problem, exact: Array) -> Iterator[tuple[int, int]]:
    """Samples begin..end (half-open) around the places where a path is outside the limits, or misses the start."""
    time = problem.time
    violation, _ = exceeded(time, exact, rig_limits(problem.rig))
    broken = violation.max(axis=1) > MET
    if problem.start is not None and np.abs(exact[0] - problem.start).max() > MET:
        broken[0] = True
    begin = end = -1
    for k in np.flatnonzero(broken):
        first = int(np.searchsorted(time, time[k] - PADDING))
        last = int(np.searchsorted(time, time[k] + PADDING, side="right"))
        if end < 0:
            begin = first
        elif first > end + APART:
            yield begin, end
            begin = first
        end = last
    if end >= 0:
        yield begin, end


def _in_pieces(problem: Problem, paths: Sequence[Array], heard: Heard) -> Array | None:
    """The flight piece after piece, each looked at beyond what is kept of it; in one where it is brief."""
    time = problem.time
    n = len(time)
    x = np.empty((n, 4))
    begin, tolerance = 0, 0.0
    while True:
        end = n if time[-1] - time[begin] <= BRIEF else int(np.searchsorted(time, time[begin] + PIECE))
        part = problem.part(begin, end)
        ends = _start_of(part) if begin == 0 else joined(time[:end], x[:end], begin), None
        found = search_stretch(part, ends, [path[begin:end] for path in paths], heard)
        if found is None:
            return None
        tolerance = max(tolerance, found.tolerance)
        heard()
        x[begin:end] = least_squares(found, tolerance).angles
        if end == n:
            return x
        begin = max(begin + 1, int(np.searchsorted(time, time[begin] + DECIDED)))


def _start_of(problem: Problem) -> End | None:
    """What is fixed at the first sample: the start, and its rate where it has one."""
    if problem.start is None:
        return None
    if problem.start_rate is None:
        return End(problem.start[None])
    return End(np.stack([problem.start, problem.start_rate]))


def joined(time: Array, path: Array, k: int) -> End:
    """Value, slope and bend of path (n, 4) [rad] at its sample k, not the first or last."""
    before, after = time[k] - time[k - 1], time[k + 1] - time[k]
    past, ahead = (path[k] - path[k - 1]) / before, (path[k + 1] - path[k]) / after
    slope = (past * after + ahead * before) / (before + after)
    return End(np.stack([path[k], slope, BEND_KEPT * 2.0 * (ahead - past) / (before + after)]))
