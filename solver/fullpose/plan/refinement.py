"""What the attempts share: the task, a path refined, how far outside the limits it is left, and where it failed."""

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from fullpose._typing import Array, Progress
from fullpose.bounds import MET, POSITION
from fullpose.plan.fallback import EXACT_ERROR, Fallback
from fullpose.trajectory.constraints import largest_violation, rig_limits
from fullpose.trajectory.needles import Needles, needles
from fullpose.trajectory.problem import Problem
from fullpose.trajectory.shortest_path import Avoid
from fullpose.trajectory.sqp import RATE_MET, missed_rate
from fullpose.trajectory.windows import Path, refine_path
from fullpose.verify import attitude_errors, payload_attitudes

AVOID_RADIUS = math.radians(30.0)
AVOID_COST = 5.0  # [1/s], beside rates squared as shares of their limits
AVOID_TIME = 0.4  # [s] before and after
STANDING = 0.05  # beyond a range by less than this, in its unit, a path may be standing on its end


@dataclass(frozen=True)
class Task:
    """What every attempt is given: the problem, paths that are taken sample by sample, and who is told of progress."""

    problem: Problem
    fallback: Fallback
    progress: Progress | None = None

    @cached_property
    def needles(self) -> Needles:
        """The needles of the flight, worked out when they are asked for, and kept."""
        problem = self.problem
        return needles(problem.time, problem.attitude, problem.rig.geometry.horizontal)

    def told(self, begin: float, share: float) -> Progress | None:
        """Progress of a part of the work, from the share `begin` on, in samples."""
        n, tell = len(self.problem), self.progress
        if tell is None:
            return None

        def report(done: int, total: int) -> None:
            tell(min(n - 1, int(n * (begin + share * done / total))), n)

        return report


def refined(task: Task, angles: Array) -> Path:
    """The path next to exact angles (n, 4) [rad], which are overwritten.

    A flight may have to stand on the end of a range, where a reserve leaves nothing: then it is refined without.
    """
    problem = task.problem
    path = refine_path(problem, angles, task.told(0.5, 0.5))
    violation = largest_violation(problem.time, path.angles, rig_limits(problem.rig))
    if violation.limit != POSITION or not MET < violation.share < STANDING:
        return path
    without = replace(problem, options=replace(problem.options, reserve=0.0, iterations=3 * problem.options.iterations))
    return refine_path(without, path.angles, task.told(0.9, 0.1))


def flown_beside(task: Task, angles: Array) -> Path | None:
    """A path inside every limit next to angles (n, 4) [rad], or those; None where they are not exact and inside."""
    problem = task.problem
    limits = rig_limits(problem.rig)
    error, _ = attitude_errors(payload_attitudes(problem.rig, angles), problem.attitude)
    if error.max() > EXACT_ERROR or largest_violation(problem.time, angles, limits).share > MET:
        return None
    path = refined(task, angles.copy())
    if largest_violation(problem.time, path.angles, limits).share <= MET:
        return path
    return Path(angles.copy(), (), np.zeros(len(angles), np.int32))


def how_far(problem: Problem, path: Path) -> float:
    """How far a path is outside the limits, as a share, or from the start rate asked for, whichever is more."""
    violation = largest_violation(problem.time, path.angles, rig_limits(problem.rig)).share
    missed = 0.0
    if problem.start_rate is not None:
        missed = missed_rate(problem.time, path.angles, problem.rig, problem.start_rate)
    return max(violation, missed - RATE_MET)


def failed_places(problem: Problem, path: Path) -> Iterator[Avoid]:
    """The places where a path failed, to be dear to the node paths to come."""
    reach = max(AVOID_TIME, problem.options.stage)
    for failure in path.failures:
        first = float(problem.time[failure.sample]) - reach
        part = slice(*np.searchsorted(problem.time, (first, first + 2.0 * reach)))
        yield Avoid(problem.time[part], path.angles[part].copy(), AVOID_RADIUS, AVOID_COST)
