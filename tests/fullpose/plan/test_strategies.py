"""The table of attempts: their order, what each looks for, and what it leaves to those after it."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from fullpose.attitude import dcm_from_quaternion
from fullpose.plan import PlanOptions, strategies
from fullpose.plan.fallback import Fallback
from fullpose.plan.node_paths import NONE, Query
from fullpose.plan.refinement import Task, how_far
from fullpose.plan.search_state import WIDE_SECONDS, State, slow, slow_base, slow_middle, slow_outer
from fullpose.plan.strategies import FARTHER, LAST, attempts, first_look, search
from fullpose.rig import builtin_rigs
from fullpose.scenarios import random_flight
from fullpose.trajectory.constraints import LimitViolation
from fullpose.trajectory.problem import Problem
from fullpose.trajectory.shortest_path import Avoid, NodePath
from fullpose.trajectory.windows import Path, stage_samples

RIG = builtin_rigs()["vertical-limited"]
OPTIONS = PlanOptions()
FOUND = NodePath(np.zeros((1, 4)), 0.0, 1)
PLACE = Avoid(np.zeros(1), np.zeros((1, 4)), 1.0, 1.0)


def task(options: PlanOptions = OPTIONS, seconds: float = 2.0, **given: Any) -> Task:
    time, q = random_flight(2, seconds, 100.0, 1.0)
    problem = Problem(time, dcm_from_quaternion(q), RIG, options, **given)
    return Task(problem, Fallback(problem))


def begun(given: Task, grid: float = OPTIONS.grid) -> State:
    samples = stage_samples(given.problem.time, OPTIONS.stage)
    return State(Query(samples, np.zeros(4, np.bool_), grid, slack=0.1), FOUND, avoid=(PLACE,))


@pytest.mark.parametrize("alternatives", [0, 1, 2, 5, 9, 12])
def test_the_options_say_how_many_are_tried(alternatives: int) -> None:
    rows = list(attempts(alternatives))
    assert {row.number for row in rows[:-1]} == set(range(alternatives + 1))
    assert [row.number for row in rows[:-1]] == sorted(row.number for row in rows[:-1])
    assert rows[-1] is LAST
    assert [row.name for row in rows].count(FARTHER.name) == max(0, alternatives - FARTHER.number + 1)


def test_the_step_method_is_asked_after_two_and_before_the_wide_searches() -> None:
    names = [row.name for row in attempts(OPTIONS.alternatives)]
    assert names.index("beside the step method") == 2
    assert names.index("sheets of level flight") == 3
    assert names.index("plane of time and base angle") < names.index("beam search") < names.index("plane, finer")


def test_the_budget_ends_a_search_and_what_was_tried_is_told(
    asked: list[Query], monkeypatch: pytest.MonkeyPatch
) -> None:
    given = task()
    monkeypatch.setattr(strategies, "BUDGET", 2.0)
    names = [row.name for row in attempts(OPTIONS.alternatives)]
    end = search(given, replace(begun(given), cheapest=NONE))
    assert end.tried[:2] == ("cheapest node path", "straight through the singularity")
    assert sum(row.work for row in attempts(OPTIONS.alternatives) if row.name in end.tried) <= 2.0
    assert [name for name in names if name in end.tried] == list(end.tried)
    assert len(asked) == 1
    monkeypatch.setattr(strategies, "BUDGET", 1e9)
    assert len(search(given, replace(begun(given), cheapest=NONE)).tried) > len(end.tried)


def test_where_no_frame_is_slow_the_budget_leaves_nothing_out() -> None:
    rows = [
        row for row in attempts(OPTIONS.alternatives) if row.applies not in (slow, slow_base, slow_outer, slow_middle)
    ]
    assert sum(row.work for row in rows) <= strategies.BUDGET


@pytest.fixture
def asked(monkeypatch: pytest.MonkeyPatch) -> list[Query]:
    """The queries of node paths, none of which finds any; each needs one more frame's turns counted."""
    queries: list[Query] = []

    def nothing(_task: Task, query: Query) -> tuple[NodePath, Query]:
        queries.append(query)
        turns = query.turns.copy()
        turns[min(len(queries), 4) - 1] = True
        return NONE, replace(query, turns=turns)

    monkeypatch.setattr(strategies, "_cheapest", nothing)
    monkeypatch.setattr(strategies, "searched", lambda *_: NONE)
    monkeypatch.setattr(strategies, "plane_path", lambda *_: None)
    monkeypatch.setattr(strategies, "flown_beside", lambda *_: None)
    return queries


def run(given: Task, state: State) -> State:
    for attempt in list(attempts(given.problem.options.alternatives))[1:-1]:
        if attempt.applies(given, state):
            state = attempt.step(given, state)
    return state


def test_what_each_attempt_looks_for(asked: list[Query]) -> None:
    given = task(PlanOptions(alternatives=10))
    state = begun(given)
    end = run(given, state)
    assert [query.margin_gain for query in asked] == [0.0, 1.0, 1.0, 4.0, 1.0, 1.0, 1.0]
    assert [bool(query.avoid) for query in asked] == [False, True, False, False, True, True, True]
    assert [query.grid / OPTIONS.grid for query in asked] == [1.0, 1.0, 0.5, 1.0, 1.0, 1.0, 1.0]
    halved = len(stage_samples(given.problem.time, 0.5 * OPTIONS.stage))
    assert [len(query.samples) for query in asked] == [len(state.query.samples)] * 2 + [halved] * 5  # as they stay
    assert [int(query.turns.sum()) for query in asked] == [0, 1, 2, 3, 4, 4, 4]  # counted from then on
    assert {query.slack for query in asked} == {0.1}
    assert end.flown is None
    assert end.node_paths == 0
    assert not state.query.turns.any()  # nothing was changed of what was given


def test_on_the_fine_grid_there_is_no_finer_one(asked: list[Query]) -> None:
    given = task()
    run(given, begun(given, OPTIONS.fine_grid))
    assert {query.grid for query in asked} == {OPTIONS.fine_grid}
    assert [bool(query.avoid) for query in asked] == [False, True, True, False, True, True]


def test_a_long_flight_is_not_searched_widely(asked: list[Query], monkeypatch: pytest.MonkeyPatch) -> None:
    breadths: list[Any] = []

    def none(*asked_for: Any) -> NodePath:
        breadths.append(asked_for[2])
        return NONE

    monkeypatch.setattr(strategies, "searched", none)
    for seconds, count in ((2.0, 3), (WIDE_SECONDS + 1.0, 1)):
        breadths.clear()
        given = task(seconds=seconds)
        run(given, begun(given))
        assert len(breadths) == count


def test_a_path_that_fails_is_avoided_and_the_least_one_kept(monkeypatch: pytest.MonkeyPatch) -> None:
    given = task()
    n = len(given.problem)
    paths = iter([0.3, 0.1, 0.2])

    def path_over(_task: Task, _angles: Any) -> Path:
        violation = next(paths)
        return Path(np.full((n, 4), violation), (LimitViolation(violation, n // 2, 0, 1),), np.zeros(n, np.int32))

    monkeypatch.setattr(strategies, "refined", path_over)
    monkeypatch.setattr(strategies, "smooth_curve", lambda *_: np.zeros((n, 4)))
    monkeypatch.setattr(strategies, "how_far", lambda _problem, path: float(path.angles[0, 0]))
    state = replace(begun(given), avoid=())
    for _ in range(3):
        state = strategies.along(strategies.kept)(given, state)
    assert (state.node_paths, state.violation, len(state.avoid)) == (3, 0.1, 3)
    assert state.best is not None
    assert state.best.angles[0, 0] == 0.1
    middle = given.problem.time[n // 2]
    assert all(place.time[0] < middle < place.time[-1] for place in state.avoid)


def test_the_search_ends_with_the_first_path_inside_the_limits() -> None:
    given = task()
    state = first_look(given)
    found = search(given, state)
    assert found.flown is not None
    assert how_far(given.problem, found.flown) <= 1e-7
    assert found.node_paths == 1
    assert state.flown is None
