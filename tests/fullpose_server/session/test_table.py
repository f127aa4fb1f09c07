"""The table against DESIGN's text, and the guide against the table."""

from pathlib import Path

import pytest

from fullpose_server.session import diagram
from fullpose_server.session.states import STATES, Action, Command, Event, State
from fullpose_server.session.table import TABLE, When, allowed, find

S, C, V = State, Command, Event
EVERY = frozenset(When)

# DESIGN, "The session", line by line.
DESIGN = [
    (S.DISCONNECTED, C.CONNECT, S.IDLE),
    (S.IDLE, C.LOAD, S.READY),
    (S.READY, C.ARM, S.ARMED),
    (S.ARMED, C.START, S.POSITIONING),
    (S.POSITIONING, V.AT_START, S.RUNNING),
    (S.RUNNING, V.END, S.ARMED),
    (S.RUNNING, C.HOLD, S.HELD),
    (S.HELD, C.RESUME, S.RUNNING),
    (S.RUNNING, C.STOP, S.STOPPING),
    (S.HELD, C.STOP, S.STOPPING),
    (S.POSITIONING, C.STOP, S.STOPPING),
    (S.STOPPING, V.AT_REST, S.ARMED),
    (S.ARMED, C.MOVE, S.POSITIONING),
    (S.POSITIONING, V.THERE, S.ARMED),
    (S.ARMED, C.GO_LIVE, S.LIVE),
    (S.LIVE, C.STOP, S.STOPPING),
    (S.LIVE, V.SOURCE_LOST, S.STOPPING),
    (S.ARMED, C.DISARM, S.READY),
    (S.READY, C.UNLOAD, S.IDLE),
    (S.FAULTED, C.RESET, S.IDLE),
    (S.ESTOPPED, C.RESET, S.IDLE),
]


@pytest.mark.parametrize(("state", "trigger", "target"), DESIGN)
def test_design_s_arrows_are_in_the_table(state: State, trigger: Command | Event, target: State) -> None:
    row = find(state, trigger, EVERY - {When.UNLINKED})
    assert row is not None
    assert row.target is target


@pytest.mark.parametrize("state", [s for s in State if s is not S.ESTOPPED])
def test_estop_works_everywhere(state: State) -> None:
    row = find(state, C.ESTOP, frozenset())
    assert row is not None
    assert row.target is S.ESTOPPED
    assert Action.BRAKE_FASTEST in row.actions


@pytest.mark.parametrize("state", [s for s in State if s not in (S.ESTOPPED, S.FAULTED, S.DISCONNECTED)])
def test_faults_and_a_lost_link_are_answered_everywhere(state: State) -> None:
    for event, target in ((V.FAULT, S.FAULTED), (V.LINK_LOST, S.DISCONNECTED)):
        row = find(state, event, frozenset())
        assert row is not None
        assert row.target is target


def test_no_two_rows_can_fire_at_once() -> None:
    exclusive = [{When.FLIGHT, When.MOVE}, {When.LINKED, When.UNLINKED}]
    pairs = [
        (row, other)
        for i, row in enumerate(TABLE)
        for other in TABLE[i + 1 :]
        if row.trigger == other.trigger and row.sources & other.sources
    ]
    assert pairs, "some rows are told apart by their condition alone"
    for row, other in pairs:
        assert {row.when, other.when} in exclusive, (row, other)


def test_every_state_is_reached_and_left() -> None:
    assert {row.target for row in TABLE} == set(State)
    assert frozenset().union(*(row.sources for row in TABLE)) == set(State)


def test_motion_is_never_commanded_outside_armed() -> None:
    for command in (C.START, C.MOVE, C.HOME, C.JOG, C.GO_LIVE):
        assert [s for s in State if command in allowed(s)] == [S.ARMED]


def test_state_codes_are_the_order_of_the_states() -> None:
    assert [s.code for s in STATES] == list(range(len(State)))


def test_the_guide_s_diagram_is_the_table_s() -> None:
    page = Path(__file__).parents[3] / "docs" / "guide" / "session.md"
    text = page.read_text("utf-8")
    assert diagram.rewrite(text) == text, "run: python -m fullpose_server.session.diagram docs/guide/session.md"


def test_a_page_without_markers_is_refused() -> None:
    with pytest.raises(ValueError, match="markers"):
        diagram.rewrite("# The session\n")
