"""The machine: refusals change nothing, binding, silence, alarms, resets. A walk through everything: test_model.py."""

import dataclasses
import time
from typing import Any

import pytest

from fullpose_server.secret import proof_of
from fullpose_server.session import table
from fullpose_server.session.actions import Bind, Given, GoLive, Move, Order, Position
from fullpose_server.session.alarms import Severity
from fullpose_server.session.binding import Binding
from fullpose_server.session.errors import BindingError, IllegalCommandError, LeaseError, NotReadyError
from fullpose_server.session.lease import LeaseAction, LeaseToken
from fullpose_server.session.machine import SessionMachine, SilencePolicy
from fullpose_server.session.states import Command, Event, State

RIG = ("rig", "a" * 64)
PROOF = proof_of("anna's secret")
PLAN = Binding("p", "b" * 64, *RIG)
LIVE = Binding("live", "c" * 64, *RIG, live=True)
POLICY = SilencePolicy(5.0, 15.0, 60.0)


class Session:
    """A machine and one operator who counts."""

    def __init__(self) -> None:
        self.machine: SessionMachine[str, str] = SessionMachine(*RIG, POLICY)
        self.now = 100.0
        self.epoch = self.machine.lease_action(LeaseAction.TAKE, "anna", self.now, PROOF).epoch
        self.sequence = 0

    def say(self, command: Command, **rest: Any) -> tuple[Order[str, str], ...]:
        self.sequence += 1
        return self.machine.command(
            command, "anna", LeaseToken(self.epoch, self.sequence, PROOF), self.now, self.given(**rest)
        )

    def given(self, **rest: Any) -> Given[str, str]:
        return Given(**{"load": "a load", "move": "a move"} | rest)

    def to(self, state: State) -> "Session":
        steps: list[Command | Event] = [Command.CONNECT, Command.LOAD, Command.ARM]
        steps += [Command.START, Event.AT_START, Command.HOLD]
        for step in steps:
            if self.machine.state is state:
                break
            if isinstance(step, Event):
                self.machine.event(step)
            else:
                self.say(step, binding=PLAN if step is Command.LOAD else None)
        assert self.machine.state is state
        return self


def memory(machine: SessionMachine[str, str]) -> dict[str, Any]:
    """Everything a machine remembers."""
    return {key: value for key, value in vars(machine).items() if key != "_owner"}


@pytest.mark.parametrize("state", [State.DISCONNECTED, State.IDLE, State.READY, State.ARMED, State.RUNNING, State.HELD])
def test_an_illegal_command_changes_nothing_and_says_what_is_allowed(state: State) -> None:
    session = Session().to(state)
    for command in Command:
        if command in table.allowed(state):
            continue
        before = memory(session.machine)
        with pytest.raises(IllegalCommandError) as refused:
            session.machine.command(command, "anna", LeaseToken(session.epoch, 1000, PROOF), session.now)
        assert memory(session.machine) == before
        assert (refused.value.state, refused.value.command) == (state, command)
        assert refused.value.allowed == table.allowed(state)


@pytest.mark.parametrize(
    ("epochs_ago", "sequence", "code"),
    [(0, 4, "stale_command"), (0, 5, "stale_command"), (1, 6, "lease_lost")],
    ids=["old", "duplicate", "former epoch"],
)
def test_a_late_a_doubled_and_a_former_holder_s_command_are_refused(epochs_ago: int, sequence: int, code: str) -> None:
    session = Session()
    session.machine.lease_action(
        LeaseAction.RELEASE, "anna", session.now, PROOF
    )  # what was sent before is of a former epoch
    session.epoch = session.machine.lease_action(LeaseAction.TAKE, "anna", session.now, PROOF).epoch
    session.sequence = 4
    session.say(Command.CONNECT)
    before = memory(session.machine)
    for command in set(Command) - {Command.STOP, Command.ESTOP}:
        with pytest.raises(LeaseError) as refused:
            session.machine.command(
                command, "anna", LeaseToken(session.epoch - epochs_ago, sequence, PROOF), session.now
            )
        assert refused.value.code == code
        assert memory(session.machine) == before


def test_load_binds_and_arm_refuses_another_pair() -> None:
    session = Session().to(State.IDLE)
    with pytest.raises(BindingError, match="the plan's rig"):
        session.say(Command.LOAD, binding=dataclasses.replace(PLAN, rig_hash="d" * 64))
    assert session.machine.state is State.IDLE
    session.say(Command.LOAD, binding=PLAN)
    with pytest.raises(BindingError, match="the plan is"):
        session.say(Command.ARM, binding=dataclasses.replace(PLAN, plan_hash="e" * 64))
    assert session.machine.state is State.READY
    session.machine.rig_hash = "f" * 64  # the rig was changed under the session
    with pytest.raises(BindingError, match="the rig is"):
        session.say(Command.ARM)


def test_start_needs_a_plan_and_go_live_a_live_source() -> None:
    session = Session().to(State.ARMED)
    with pytest.raises(NotReadyError, match="live source"):
        session.say(Command.GO_LIVE)
    session.say(Command.DISARM)
    session.say(Command.UNLOAD)
    session.say(Command.LOAD, binding=LIVE)
    session.say(Command.ARM)
    with pytest.raises(NotReadyError, match="a plan loaded"):
        session.say(Command.START)
    assert session.say(Command.GO_LIVE) == (GoLive("anna"),)


def test_orders_carry_what_was_made_ready() -> None:
    session = Session().to(State.IDLE)
    assert session.say(Command.LOAD, binding=PLAN) == (Bind(PLAN, "a load"),)
    session.say(Command.ARM)
    assert session.say(Command.JOG, move="a jog") == (Move("a jog"),)
    session.machine.event(Event.THERE)
    assert session.say(Command.START) == (Position("a move", "anna"),)


@pytest.mark.parametrize(
    ("state", "command", "missing"),
    [
        (State.IDLE, Command.LOAD, {"binding": PLAN, "load": None}),
        (State.ARMED, Command.START, {"move": None}),
        (State.ARMED, Command.HOME, {"move": None}),
    ],
)
def test_what_was_not_made_ready_is_refused_and_changes_nothing(
    state: State, command: Command, missing: dict[str, Any]
) -> None:
    session = Session().to(state)
    before = memory(session.machine)
    with pytest.raises(NotReadyError):
        session.say(command, **missing)
    assert memory(session.machine) == before


def test_positioning_for_a_flight_and_for_a_move_end_differently() -> None:
    session = Session().to(State.ARMED)
    session.say(Command.MOVE)
    session.machine.event(Event.AT_START)
    assert session.machine.state is State.POSITIONING
    session.machine.event(Event.THERE)
    assert session.machine.state is State.ARMED
    session.say(Command.START)
    session.machine.event(Event.THERE)
    assert session.machine.state is State.POSITIONING
    session.machine.event(Event.AT_START)
    assert session.machine.state is State.RUNNING


def test_a_silent_owner_is_held_then_stopped_then_disarmed() -> None:
    session = Session().to(State.RUNNING)
    machine = session.machine
    seen = []
    for second in range(80):
        for event in machine.silence(session.now + second):
            machine.event(event)
            seen.append((second, machine.state))
        if second == 20:
            machine.event(Event.AT_REST)
    assert seen == [(6, State.HELD), (16, State.STOPPING), (61, State.READY)]


def test_a_holder_who_may_command_no_longer_is_held_at_once_and_stopped_and_disarmed_as_after_a_silence() -> None:
    session = Session().to(State.RUNNING)
    machine, begun = session.machine, session.now
    assert machine.silence(begun) == ()
    revision = machine.revision
    assert machine.lapse("anna", begun).holder is None
    assert (machine.revision, machine.lapsed) == (revision + 1, True)
    due = [(tenth / 10, event) for tenth in range(1, 600) for event in machine.silence(begun + tenth / 10)]
    assert due == [(0.1, Event.SILENT_HOLD), (10.1, Event.SILENT_STOP), (55.1, Event.SILENT_DISARM)]
    machine.lapse("anna", begun + 60.0)
    assert machine.revision == revision + 1


def test_speech_starts_silence_over() -> None:
    session = Session().to(State.RUNNING)
    machine = session.machine
    assert machine.silence(session.now + 6) == (Event.SILENT_HOLD,)
    machine.lease_action(LeaseAction.RENEW, "anna", session.now + 7, PROOF)
    assert machine.silence(session.now + 8) == ()
    assert machine.silence(session.now + 13) == (Event.SILENT_HOLD,)
    # A long sleep of the process itself names every stage, in order.
    assert machine.silence(session.now + 900) == (Event.SILENT_STOP, Event.SILENT_DISARM)


def test_reset_waits_for_rest_and_acknowledgement() -> None:
    session = Session().to(State.RUNNING)
    machine = session.machine
    machine.alarm("guard_rate", Severity.FAULT, "too fast", 0.0, frame="inner")
    machine.alarm("following_error", Severity.FAULT, "and so on", 0.0, frame="inner")
    machine.event(Event.FAULT)
    assert [a.first for a in machine.alarms.standing] == [True, False]
    with pytest.raises(NotReadyError, match="at rest"):
        session.say(Command.RESET)
    machine.event(Event.AT_REST)
    with pytest.raises(NotReadyError, match="guard_rate, following_error"):
        session.say(Command.RESET)
    session.say(Command.ACKNOWLEDGE, alarms=frozenset({1}))
    with pytest.raises(NotReadyError, match="following_error"):
        session.say(Command.RESET)
    session.say(Command.ACKNOWLEDGE)
    session.say(Command.RESET)
    assert machine.state is State.IDLE
    assert machine.binding is None
    assert machine.alarms.standing == ()
    assert [a.acknowledged_by for a in machine.alarms.history] == ["anna", "anna"]


@pytest.mark.parametrize("connected", [False, True])
def test_a_lost_link_that_was_acknowledged_is_not_the_cause_of_the_next_fault(connected: bool) -> None:
    session = Session().to(State.RUNNING)
    machine = session.machine
    machine.alarm("link_lost", Severity.FAULT, "", 0.0)
    machine.event(Event.LINK_LOST)
    for command in (Command.CONNECT, Command.ACKNOWLEDGE) if connected else (Command.ACKNOWLEDGE, Command.CONNECT):
        session.say(command)
    assert machine.alarms.standing == ()
    assert [(a.code, a.acknowledged_by) for a in machine.alarms.history] == [("link_lost", "anna")]
    session.say(Command.LOAD, binding=PLAN)
    session.say(Command.ARM)
    assert machine.alarm("guard_rate", Severity.FAULT, "", 1.0).first


def test_what_nobody_acknowledged_stands_on_over_a_connect() -> None:
    session = Session()
    session.machine.alarm("rig_process_lost", Severity.FAULT, "", 0.0)
    session.say(Command.CONNECT)
    assert [a.first for a in session.machine.alarms.unacknowledged] == [True]


def test_a_latch_is_not_cleared_by_pulling_the_cable() -> None:
    session = Session().to(State.RUNNING)
    machine = session.machine
    machine.command(Command.ESTOP, "anyone", None, session.now)
    machine.event(Event.LINK_LOST)
    assert machine.state is State.ESTOPPED
    session.say(Command.RESET)
    assert machine.state is State.DISCONNECTED


def test_a_revision_for_every_visible_change() -> None:
    session = Session()
    machine = session.machine
    seen = [machine.revision]
    session.say(Command.CONNECT)
    seen.append(machine.revision)
    machine.alarm("x", Severity.WARNING, "", 0.0)
    seen.append(machine.revision)
    machine.lease_action(LeaseAction.REQUEST, "bert", session.now, proof_of("bert's secret"))
    seen.append(machine.revision)
    machine.lease_action(LeaseAction.RENEW, "anna", session.now, PROOF)
    assert seen == sorted(set(seen))
    assert machine.revision == seen[-1]  # a renewal is not news


def test_silence_policies_must_rise() -> None:
    with pytest.raises(ValueError, match="hold_s < stop_s"):
        SilencePolicy(5.0, 5.0, 6.0)


def test_the_machine_asks_no_clock(monkeypatch: pytest.MonkeyPatch) -> None:
    def refuse() -> float:
        raise AssertionError("the machine read a clock")

    for name in ("time", "monotonic", "perf_counter"):
        monkeypatch.setattr(time, name, refuse)
    Session().to(State.HELD)
