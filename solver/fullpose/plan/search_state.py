"""What a search has come to, and when an attempt is worth its work."""

import math
from dataclasses import dataclass

from fullpose.plan.level_path import is_level
from fullpose.plan.node_paths import Query
from fullpose.plan.plane_path import slow_frames
from fullpose.plan.refinement import Task
from fullpose.trajectory.frame_chart import BASE, MIDDLE, OUTER
from fullpose.trajectory.shortest_path import Avoid, NodePath
from fullpose.trajectory.sqp import locked
from fullpose.trajectory.windows import Path

NEAR = 1.0  # beyond the limits by this share at most, a path may come inside them next to where it is
WIDE_SECONDS = 600.0  # of a flight that is searched widely: up to a tenth of its length each time


@dataclass(frozen=True)
class State:
    """What the attempts so far have come to."""

    query: Query  # as the next node path is looked for, but for what an attempt changes of it for itself
    cheapest: NodePath  # found, or how far the widest search came
    avoid: tuple[Avoid, ...] = ()  # around the places that failed
    node_paths: int = 0  # that were refined
    best: Path | None = None  # of those, the least outside the limits,
    violation: float = math.inf  # by this share
    flown: Path | None = None  # inside them: the end of the search
    tried: tuple[str, ...] = ()  # the names of the attempts that were taken, in turn


def always(_task: Task, _state: State) -> bool:
    """Whatever came before."""
    return True


def free(task: Task, state: State) -> bool:
    """Where there is something to choose."""
    return len(state.query.samples) > 1 and not locked(task.problem.rig)


def free_and_brief(task: Task, state: State) -> bool:
    """Where a wide search does not take too long, too."""
    time = task.problem.time
    return free(task, state) and bool(time[-1] - time[0] <= WIDE_SECONDS)


def slow(task: Task, state: State) -> bool:
    """Where a frame other than the base is slow, too."""
    return free_and_brief(task, state) and bool(slow_frames(task.problem.rig))


def nimble(task: Task, state: State) -> bool:
    """Where no frame is slow: the beam search's slides are steps that a slow frame cannot use, and node paths know
    rates alone, which say nothing of it."""
    return free(task, state) and not slow_frames(task.problem.rig, base=True)


def nimble_and_brief(task: Task, state: State) -> bool:
    """Likewise, where a wide search does not take too long."""
    return nimble(task, state) and free_and_brief(task, state)


def slow_base(task: Task, state: State) -> bool:
    """Where the base is slow."""
    return free_and_brief(task, state) and BASE in slow_frames(task.problem.rig, base=True)


def quick_base(task: Task, state: State) -> bool:
    """Where it is not."""
    return free_and_brief(task, state) and not slow_base(task, state)


def slow_outer(task: Task, state: State) -> bool:
    """Where the outer frame is slow."""
    return free_and_brief(task, state) and OUTER in slow_frames(task.problem.rig)


def slow_middle(task: Task, state: State) -> bool:
    """Where the middle frame is slow."""
    return free_and_brief(task, state) and MIDDLE in slow_frames(task.problem.rig)


def near(_task: Task, state: State) -> bool:
    """Where a path came near to the limits, or none was refined."""
    return state.best is None or state.violation <= NEAR


def level(task: Task, state: State) -> bool:
    """Where the flight is level throughout."""
    return free(task, state) and is_level(task.problem)


def coarse(task: Task, state: State) -> bool:
    """Where a path came near, on a grid that is not the fine one yet."""
    return near(task, state) and state.query.grid > task.problem.options.fine_grid


def fine(task: Task, state: State) -> bool:
    """Where it is."""
    return near(task, state) and not state.query.grid > task.problem.options.fine_grid


def best_effort(task: Task, _state: State) -> bool:
    """Where time is spent on flights that seem infeasible."""
    return task.problem.options.best_effort
