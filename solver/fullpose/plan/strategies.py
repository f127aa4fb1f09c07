"""How a path inside every limit is looked for: a table of attempts, taken in turn until one has it.

An attempt is given the task, which does not change, and the state that those before it came to, and returns the next
state. What each of them adds was measured (docs/decisions/0005-planner.md).
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace

import numpy as np

from fullpose._typing import Array
from fullpose.bounds import MET
from fullpose.plan.beam_path import BREADTHS
from fullpose.plan.fallback import Fallback
from fullpose.plan.level_path import level_path
from fullpose.plan.node_paths import Query, cheapest, searched
from fullpose.plan.plane_path import PlaneBreadth, plane_path
from fullpose.plan.refinement import Task, failed_places, flown_beside, how_far, refined
from fullpose.plan.search_state import (
    State,
    always,
    best_effort,
    coarse,
    fine,
    free_and_brief,
    level,
    near,
    nimble,
    nimble_and_brief,
    quick_base,
    slow,
    slow_base,
    slow_middle,
    slow_outer,
)
from fullpose.trajectory.frame_chart import INNER, MIDDLE, OUTER
from fullpose.trajectory.nodes import OVERLAP
from fullpose.trajectory.options import PlanOptions
from fullpose.trajectory.shortest_path import Avoid, NodePath
from fullpose.trajectory.windows import Path, smooth_curve, stage_samples

BUDGET = 32.0  # times the work of the first attempt, or so, that all may take: see `Attempt.work`


Step = Callable[[Task, State], State]
Find = Callable[[Task, State], tuple[NodePath, State]]


def first_look(task: Task) -> State:
    """The cheapest node path, on the fine grid where the coarse one has none, there widened by the covering step.

    What is not found so wide does not exist away from the singularity (mathematics, section 8).
    """
    options = task.problem.options
    samples = stage_samples(task.problem.time, options.stage)
    query = Query(samples, np.zeros(4, np.bool_), options.grid)
    node_path, query = _cheapest(task, query)
    if node_path.found:
        return State(query, node_path)
    query = replace(query, grid=options.fine_grid)
    slack = options.fine_grid / OVERLAP
    wide, answered = _cheapest(task, replace(query, slack=slack))
    query = replace(query, turns=answered.turns)
    if not wide.found:
        return State(query, wide)
    node_path, query = _cheapest(task, query)
    return State(query, node_path) if node_path.found else State(replace(query, slack=slack), wide)


def _cheapest(task: Task, query: Query) -> tuple[NodePath, Query]:
    return cheapest(task.problem, query, task.told(0.0, 0.5))


# What an attempt does


def along(find: Find) -> Step:
    """Refine the node path that `find` has; where that fails, the places it failed at are to be avoided."""

    def step(task: Task, state: State) -> State:
        node_path, state = find(task, state)
        if not node_path.found:
            return state
        return judged(task, state, refined(task, smooth_curve(task.problem, state.query.samples, node_path)))

    return step


def judged(task: Task, state: State, path: Path) -> State:
    """The state with one more refined path: the end of the search, or places that failed, to be avoided."""
    violation = how_far(task.problem, path)
    state = replace(state, node_paths=state.node_paths + 1)
    if violation < state.violation:
        state = replace(state, best=path, violation=violation)
    if violation <= MET:
        return replace(state, flown=path)
    return replace(state, avoid=(*state.avoid, *failed_places(task.problem, path)))


def in_the_plane(breadth: PlaneBreadth) -> Step:
    """Refine the path that the search in the plane of time and base angle finds."""

    def step(task: Task, state: State) -> State:
        angles = plane_path(task.problem, task.needles, breadth, task.told(0.0, 0.5))
        return state if angles is None else judged(task, state, refined(task, angles))

    return step


def on_sheets(task: Task, state: State) -> State:
    """Take the path that changes between the sheets of a level flight's solutions."""
    angles = level_path(task.problem)
    return state if angles is None else judged(task, state, Path(angles, (), np.zeros(len(angles), np.int32)))


def beside(paths: Callable[[Fallback], tuple[Array, ...]]) -> Step:
    """Refine paths of the fallback that are exact and inside every limit; one that does not come out so is taken as
    it is. No flight is refused that a method flies which looks at less of it."""

    def step(task: Task, state: State) -> State:
        if task.problem.start_rate is not None:  # they know nothing of it
            return state
        for angles in paths(task.fallback):
            if (path := flown_beside(task, angles)) is not None:
                return replace(state, flown=path)
        return state

    return step


def kept(_task: Task, state: State) -> tuple[NodePath, State]:
    """The node path of the first look."""
    return state.cheapest, state


def straight(task: Task, state: State) -> tuple[NodePath, State]:
    """Without a price on the singularity: a flight that must pass through it is better off going straight."""
    return _looked_for(task, state, margin_gain=0.0)


def away(task: Task, state: State) -> tuple[NodePath, State]:
    """Away from the places that failed; they are more each time."""
    return _looked_for(task, state, avoid=state.avoid)


def finer(task: Task, state: State) -> tuple[NodePath, State]:
    """On a grid twice as fine, with stages half as far apart, as they stay from then on."""
    problem = task.problem
    samples = stage_samples(problem.time, 0.5 * problem.options.stage)
    state = replace(state, query=replace(state.query, samples=samples))
    return _looked_for(task, state, grid=0.5 * state.query.grid)


def dearer(task: Task, state: State) -> tuple[NodePath, State]:
    """With four times the price on the singularity."""
    return _looked_for(task, state, margin_gain=4.0)


def searching(number: int) -> Find:
    """By the beam search, which knows the accelerations, with one of `BREADTHS`."""

    def find(task: Task, state: State) -> tuple[NodePath, State]:
        return searched(task.problem, state.query.samples, BREADTHS[number], task.told(0.0, 0.5)), state

    return find


def _looked_for(
    task: Task, state: State, grid: float | None = None, margin_gain: float = 1.0, avoid: tuple[Avoid, ...] = ()
) -> tuple[NodePath, State]:
    """A node path of the state's query, changed for this once; the turns that it needed are counted from now on."""
    query = replace(state.query, grid=grid or state.query.grid, margin_gain=margin_gain, avoid=avoid)
    node_path, answered = _cheapest(task, query)
    return node_path, replace(state, query=replace(state.query, turns=answered.turns))


# The table


@dataclass(frozen=True)
class Attempt:
    """One row: where it counts among `PlanOptions.alternatives`, what it is called, when it applies, what it does, and
    how much work it is, as a number of node paths: a measured figure, so that where a search ends is no matter of the
    machine."""

    number: int
    name: str
    applies: Callable[[Task, State], bool]
    step: Step
    work: float = 1.0


# In the order of what they promise for their work.
ATTEMPTS = (
    Attempt(0, "cheapest node path", always, along(kept)),
    Attempt(1, "straight through the singularity", nimble, along(straight)),
    Attempt(2, "beside the step method", always, beside(lambda fallback: (fallback.exact,)), 0.1),
    Attempt(2, "sheets of level flight", level, on_sheets, 2.0),
    Attempt(2, "plane of time and base angle", slow_base, in_the_plane(PlaneBreadth(1000, 1.0, 1.0)), 3.0),
    Attempt(
        2, "plane of time and outer angle", slow_outer, in_the_plane(PlaneBreadth(1000, 1.0, 1.0, frame=OUTER)), 3.0
    ),
    Attempt(
        2, "plane of time and middle angle", slow_middle, in_the_plane(PlaneBreadth(1000, 1.0, 1.0, frame=MIDDLE)), 3.0
    ),
    Attempt(2, "plane of time and base angle", quick_base, in_the_plane(PlaneBreadth(1000, 1.0, 1.0)), 3.0),
    Attempt(2, "beam search", nimble, along(searching(0)), 2.0),
    Attempt(
        2,
        "plane of time and inner angle",
        nimble_and_brief,
        in_the_plane(PlaneBreadth(1000, 1.0, 1.0, frame=INNER)),
        3.0,
    ),
    Attempt(
        2,
        "plane of time and outer angle, finer",
        slow_outer,
        in_the_plane(PlaneBreadth(4000, 0.7, 0.7, frame=OUTER)),
        8.0,
    ),
    Attempt(
        2,
        "plane of time and middle angle, finer",
        slow_middle,
        in_the_plane(PlaneBreadth(4000, 0.7, 0.7, frame=MIDDLE)),
        8.0,
    ),
    Attempt(2, "plane, slow frames lead", slow, in_the_plane(PlaneBreadth(4000, 2.0, 2.0, slow_lead=True)), 7.0),
    Attempt(2, "plane, slow frames lead, finer", slow, in_the_plane(PlaneBreadth(4000, 1.0, 1.0, slow_lead=True)), 8.0),
    Attempt(2, "plane, finer", free_and_brief, in_the_plane(PlaneBreadth(2000, 0.6, 0.5)), 4.0),
    Attempt(3, "wider beam search", nimble_and_brief, along(searching(1)), 4.0),
    Attempt(4, "wider beam search, accelerations dearer", nimble_and_brief, along(searching(2)), 4.0),
    Attempt(5, "away from the places that failed", near, along(away)),
    Attempt(6, "finer grid and stages", coarse, along(finer), 1.5),
    Attempt(6, "farther away", fine, along(away)),
    Attempt(7, "singularity dearer", near, along(dearer)),
)
FARTHER = Attempt(8, "ever farther away", near, along(away))  # and all after it
LAST = Attempt(0, "beside previews that know much of the flight", best_effort, beside(lambda f: f.foreseen), 0.0)


def attempts(alternatives: int) -> Iterator[Attempt]:
    """The rows in turn, as far as the options go."""
    yield from (attempt for attempt in ATTEMPTS if attempt.number <= alternatives)
    for number in range(FARTHER.number, alternatives + 1):
        yield replace(FARTHER, number=number)
    yield LAST


def search(task: Task, state: State) -> State:
    """The state after the first attempt that finds a path inside every limit, or after the last that the budget pays
    for: what is too much work for the rest of it is left out."""
    alternatives = task.problem.options.alternatives
    left = BUDGET * max(1.0, alternatives / PlanOptions().alternatives)
    for attempt in attempts(alternatives):
        if attempt.work > left or not attempt.applies(task, state):
            continue
        state = replace(attempt.step(task, state), tried=(*state.tried, attempt.name))
        left -= attempt.work
        if state.flown is not None:
            break
    return state
