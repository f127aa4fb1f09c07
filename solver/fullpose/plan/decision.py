"""What becomes of a flight: an exact path inside every limit, or what closes the way and the least tolerance."""

import math
from dataclasses import dataclass, replace

import numpy as np

from fullpose._typing import Array, Codes, Counts
from fullpose.bounds import MET, limited_code
from fullpose.methods.start_pose import start_pose
from fullpose.plan.active_limits import active_limits
from fullpose.plan.fallback import EXACT_ERROR, Fallback
from fullpose.plan.impossible import beyond_all_frames
from fullpose.plan.least_tolerance import BRIEF, LeastTolerance, least_tolerance
from fullpose.plan.node_paths import cheapest
from fullpose.plan.recorded_noise import recorded_noise
from fullpose.plan.refinement import Task, how_far, refined
from fullpose.plan.search_state import State
from fullpose.plan.strategies import first_look, search
from fullpose.plan.three_axis import three_axis_path
from fullpose.rig import FRAMES, LIMITS, Limit
from fullpose.solution import Blocking
from fullpose.trajectory.constraints import largest_violation, rig_limits
from fullpose.trajectory.curve import closest_all
from fullpose.trajectory.problem import Problem
from fullpose.trajectory.windows import Path, smooth_curve
from fullpose.verify import attitude_errors, payload_attitudes
from fullpose.vocabulary import Decision

STRETCH = 4.0  # times the rate limit that an edge may take, at a price, for a flight without a node path
VIOLATION_COST = 100.0  # that price: the cost of going over a rate limit by its whole
WIDENED = 0.5  # [rad] that ranges are widened by where even that finds none
SAME_STAMP = 1e-9  # [s]
NEARLY_EXACT = math.radians(0.02)  # tolerance below which an exact path is near
BROKEN = 100.0  # times a limit: a path that jumps, of no use to begin with

# Which limit closed the last stage, and what decided then: only the inertia of a start rate closes by acceleration.
CLOSED_BY = {
    Limit.POSITION: Decision.POSITION, Limit.RATE: Decision.RATE, Limit.ACCELERATION: Decision.START_RATE,
}  # fmt: skip


@dataclass(frozen=True)
class Flown:
    """What the search came to: angles (n, 4), iterations (n,), limited codes (n,), and who decided if it failed."""

    angles: Array
    iterations: Counts
    limited: Codes
    decided_by: Decision
    blocking: Blocking | None
    grid: float = math.nan  # [rad] of the search
    node_paths: int = 0  # that were refined
    tried: tuple[str, ...] = ()  # the attempts, in turn

    def held(self, n: int) -> "Flown":
        """Its first sample, held over n."""
        angles, iterations = np.repeat(self.angles[:1], n, axis=0), np.repeat(self.iterations[:1], n)
        return replace(self, angles=angles, iterations=iterations, limited=np.repeat(self.limited[:1], n))


def fly(task: Task) -> Flown:
    """A path of a four-axis rig, found by the table of attempts; else the least tolerance."""
    if (beyond := beyond_all_frames(task.problem.time, task.problem.attitude, task.problem.rig)) is not None:
        return _beyond(task, beyond.time)
    state = first_look(task)
    if state.cheapest.found:
        state = search(task, state)
    if state.flown is not None:
        return _inside(state, state.flown.angles, state.flown)
    if state.best is not None:
        return _outside(task, state, state.best)
    return _without_node_path(task, state)


def _beyond(task: Task, when: float) -> Flown:
    """No path exists, nor is one looked for: the flight behind its noise where that fits, or the least tolerance."""
    problem, n = task.problem, len(task.problem)
    most = int(np.argmax(np.where(problem.rig.axes >= 0, problem.rig.max_acceleration, -1.0)))
    failed = Flown(
        np.repeat(problem.rig.home[None], n, axis=0), np.zeros(n, np.int32),
        np.full(n, limited_code(most, LIMITS.index(Limit.ACCELERATION)), np.int16), Decision.BEYOND,
        Blocking(when, FRAMES[most], Limit.ACCELERATION),
    )  # fmt: skip
    if not problem.options.best_effort:
        return failed
    least = _behind_noise(task) or least_tolerance(problem, [task.fallback.exact], task.progress)
    return _given_up(problem, failed, least)


def _behind_noise(task: Task) -> LeastTolerance | None:
    """The plan of the flight behind its noise, where its stamps may stay and it fits: its error is the noise."""
    problem = task.problem
    smoothed = recorded_noise(problem.time, problem.attitude) if problem.start_rate is None else None
    if smoothed is None or np.abs(smoothed.time - problem.time).max() > SAME_STAMP:
        return None
    start = None if problem.start is None else start_pose(problem.rig, smoothed.attitude[0], problem.start)[0]
    options = replace(problem.options, best_effort=False)
    behind = replace(problem, attitude=np.array(smoothed.attitude), start=start, options=options)
    state = first_look(Task(behind, Fallback(behind), task.progress))
    if state.cheapest.found:
        state = search(Task(behind, Fallback(behind), task.progress), state)
    if state.flown is None:
        return None
    angles = state.flown.angles
    error, _ = attitude_errors(payload_attitudes(problem.rig, angles), problem.attitude)
    missed = error > EXACT_ERROR
    limited = active_limits(problem.time, problem.attitude, angles, problem.rig, missed)
    return LeastTolerance(angles, limited, float(error.max()))


def _inside(state: State, angles: Array, path: Path) -> Flown:
    """Angles that are exact and inside every limit."""
    none = np.zeros(len(angles), np.int16)
    return Flown(angles, path.iterations, none, Decision.CHECKED, None, state.query.grid, state.node_paths, state.tried)


def _outside(task: Task, state: State, path: Path) -> Flown:
    """No path that was refined is inside every limit: the worst place of `path`, the best, and the least tolerance."""
    problem = task.problem
    blocking, decided_by = _closed(problem, path)
    failed = Flown(
        path.angles, path.iterations, np.zeros(len(problem), np.int16), decided_by, blocking, state.query.grid,
        state.node_paths, state.tried,
    )  # fmt: skip
    if not problem.options.best_effort:
        return failed
    least = least_tolerance(problem, [path.angles, task.fallback.exact], task.progress)
    if not least.limited.any() and problem.start_rate is None:  # not even that gave the attitude up
        return _inside(state, least.angles, path)
    if (exact := _back_on_solutions(task, least)) is not None:
        return _inside(state, exact.angles, exact)
    return _given_up(problem, failed, least)


def _back_on_solutions(task: Task, least: LeastTolerance) -> Path | None:
    """The exact path beside one of nearly no tolerance that all frames found inside the jerk limits; None: none.

    Put back as it is, the small error that is gone leaves its third differences behind.
    """
    problem = task.problem
    if not problem.rig.jerk_limited or least.tolerance > NEARLY_EXACT:
        return None
    angles = least.angles.copy()
    closest_all(problem.rig.axes, problem.rig.geometry.horizontal, problem.attitude, angles)
    path = refined(task, angles)
    return path if how_far(problem, path) <= MET else None


def _given_up(problem: Problem, failed: Flown, least: LeastTolerance) -> Flown:
    """A flight that is not exact: flown all the same where that is within the tolerance asked for."""
    if least.tolerance <= problem.options.tolerance:
        none = np.zeros_like(failed.limited)
        return replace(failed, angles=least.angles, limited=none, decided_by=Decision.TOLERANCE, blocking=None)
    return replace(failed, angles=least.angles, limited=least.limited)


def _closed(problem: Problem, path: Path) -> tuple[Blocking, Decision]:
    """Where a path is farthest outside the limits; inside them, whose start rate it misses."""
    violation = largest_violation(problem.time, path.angles, rig_limits(problem.rig))
    if violation.share > MET or problem.start_rate is None:
        return violation.blocking(problem.time), Decision.ACCELERATION
    interval = problem.time[1] - problem.time[0]
    off = np.abs(problem.start_rate - (path.angles[1] - path.angles[0]) / interval)
    return Blocking(float(problem.time[1]), FRAMES[int(np.argmax(off))], Limit.RATE), Decision.START_RATE


def _without_node_path(task: Task, state: State) -> Flown:
    """No node path leads through: the limit that closes the stage after the last one reached, the least tolerance."""
    problem, closed = task.problem, state.cheapest
    n = len(problem)
    when = float(problem.time[state.query.samples[closed.reached]])
    blocking = Blocking(when, FRAMES[closed.frame], LIMITS[closed.limit])
    failed = Flown(
        np.repeat(problem.rig.home[None], n, axis=0), np.zeros(n, np.int32),
        np.full(n, limited_code(closed.frame, closed.limit), np.int16), CLOSED_BY[blocking.limit], blocking,
        state.query.grid, state.node_paths,
    )  # fmt: skip
    if not problem.options.best_effort:
        return failed
    path, node_paths = _least_violation(task, state)
    paths = [task.fallback.exact] if path is None else [path.angles, task.fallback.exact]
    least = least_tolerance(problem, paths, task.progress)
    return _given_up(problem, replace(failed, node_paths=node_paths), least)


def _least_violation(task: Task, state: State) -> tuple[Path | None, int]:
    """(an exact path that is least over the limits, of a flight too long to be looked at in one piece; the node paths
    refined)."""
    problem = task.problem
    if problem.time[-1] - problem.time[0] <= BRIEF:
        return None, state.node_paths
    query = replace(state.query, grid=problem.options.grid, stretch=STRETCH, violation_cost=VIOLATION_COST)
    for slack in (0.0, WIDENED):
        node_path, query = cheapest(problem, replace(query, slack=slack), task.told(0.0, 0.5))
        if not node_path.found:
            continue
        angles = smooth_curve(problem, query.samples, node_path)
        if largest_violation(problem.time, angles, rig_limits(problem.rig)).share > BROKEN:
            break
        return refined(task, angles), state.node_paths + 1
    return None, state.node_paths


def fly_three_axis(problem: Problem) -> Flown:
    """Without freedom: the Euler angles; where they leave the limits, the least tolerance inside them."""
    angles = three_axis_path(problem.time, problem.attitude, problem.rig, problem.start)
    violation = largest_violation(problem.time, angles, rig_limits(problem.rig))
    iterations, limited = np.zeros(len(problem), np.int32), np.zeros(len(problem), np.int16)
    if violation.share <= MET:
        return Flown(angles, iterations, limited, Decision.CHECKED, None)
    failed = Flown(angles, iterations, limited, Decision.THREE_AXIS, violation.blocking(problem.time))
    if not problem.options.best_effort:
        return failed
    anywhere = replace(problem, start=None)  # its first pose is to give way like any other
    return _given_up(problem, failed, least_tolerance(anywhere, [angles]))
