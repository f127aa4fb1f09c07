"""The machine: refusals change nothing, binding, silence, resets; and a model-based walk through everything."""

import dataclasses
import time
from typing import Any

import pytest
from hypothesis import HealthCheck, settings
from hypothesis import strategies as st
from hypothesis.stateful import RuleBasedStateMachine, invariant, precondition, rule

from server.session import table
from server.session.alarms import Severity
from server.session.errors import BindingError, IllegalCommandError, LeaseError, NotReadyError, SessionError
from server.session.lease import LeaseToken
from server.session.machine import Binding, SessionMachine, SilencePolicy
from server.session.states import IN_MOTION, NEEDS_NO_LEASE, Action, Command, Event, State
from server.session.table import When

RIG = ("rig", "a" * 64)
PLAN = Binding("p", "b" * 64, *RIG)
LIVE = Binding("live", "c" * 64, *RIG, live=True)
POLICY = SilencePolicy(5.0, 15.0, 60.0)


class Session:
    """A machine and one operator who counts."""

    def __init__(self) -> None:
        self.machine = SessionMachine(*RIG, POLICY)
        self.now = 100.0
        self.epoch = self.machine.lease_action("take", "anna", self.now).epoch
        self.sequence = 0

    def say(self, command: Command, **rest: Any) -> tuple[Action, ...]:
        self.sequence += 1
        return self.machine.command(command, "anna", LeaseToken(self.epoch, self.sequence), self.now, **rest)

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


def memory(machine: SessionMachine) -> dict[str, Any]:
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
            session.machine.command(command, "anna", LeaseToken(session.epoch, 1000), session.now)
        assert memory(session.machine) == before
        assert (refused.value.state, refused.value.command) == (state, command)
        assert refused.value.allowed == table.allowed(state)


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
    assert session.say(Command.GO_LIVE) == (Action.GO_LIVE,)


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


def test_speech_starts_silence_over() -> None:
    session = Session().to(State.RUNNING)
    machine = session.machine
    assert machine.silence(session.now + 6) == (Event.SILENT_HOLD,)
    machine.lease_action("renew", "anna", session.now + 7)
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
    machine.lease_action("request", "bert", session.now)
    seen.append(machine.revision)
    machine.lease_action("renew", "anna", session.now)
    assert seen == sorted(set(seen))
    assert machine.revision == seen[-1]  # a renewal is not news


class Model(RuleBasedStateMachine):
    """Random commands, events, leases, alarms and time, against a model that knows only the table."""

    def __init__(self) -> None:
        super().__init__()
        self.machine = SessionMachine(*RIG, POLICY)
        self.now = 0.0
        self.state = State.DISCONNECTED
        self.linked = False
        self.flight = False
        self.holder: str | None = None
        self.epoch = 0
        self.sequence = 0

    def expected(self, trigger: Command | Event) -> State | None:
        holding = {When.FLIGHT if self.flight else When.MOVE, When.LINKED if self.linked else When.UNLINKED}
        rows = [
            row
            for row in table.TABLE
            if row.trigger == trigger and self.state in row.sources and (row.when in holding or row.when is When.ALWAYS)
        ]
        assert len(rows) <= 1
        return rows[0].target if rows else None

    @rule(seconds=st.floats(0.0, 30.0))
    def pass_time(self, seconds: float) -> None:
        self.now += seconds

    @rule(who=st.sampled_from(["anna", "bert"]), action=st.sampled_from(["take", "takeover", "release", "renew"]))
    def lease(self, who: str, action: str) -> None:
        before = memory(self.machine)
        try:
            lease = self.machine.lease_action(action, who, self.now)
        except LeaseError:
            assert memory(self.machine) == before
            assert self.holder != who
            return
        if action in ("take", "takeover") and self.holder != who:
            assert lease.epoch > self.epoch
            self.holder, self.sequence = who, 0
        elif action == "release":
            assert self.holder == who
            self.holder = None
        self.epoch = lease.epoch

    @rule(
        command=st.sampled_from(list(Command)),
        who=st.sampled_from(["anna", "bert"]),
        step=st.integers(-1, 3),
        old=st.booleans(),
        binding=st.sampled_from([None, PLAN, LIVE, dataclasses.replace(PLAN, plan_hash="9" * 64)]),
    )
    def command(self, command: Command, who: str, step: int, old: bool, binding: Binding | None) -> None:
        token = LeaseToken(self.epoch - old, self.sequence + step)
        before = memory(self.machine)
        entitled = command in NEEDS_NO_LEASE or (self.holder == who and not old and step > 0)
        target = self.expected(command)
        try:
            actions = self.machine.command(command, who, token, self.now, binding=binding)
        except SessionError as refusal:
            assert memory(self.machine) == before
            if entitled and command is not Command.ACKNOWLEDGE and target is None:
                assert type(refusal) is IllegalCommandError  # noqa: PT017
            return
        assert entitled
        if command not in NEEDS_NO_LEASE:
            self.sequence = token.sequence
        if command is Command.ACKNOWLEDGE:
            return
        assert target is not None
        self.state = target
        if command is Command.CONNECT:
            self.linked = True
        if command in (Command.START, Command.MOVE, Command.HOME, Command.JOG):
            self.flight = command is Command.START
        assert (Action.BRAKE_FASTEST in actions) == (command is Command.ESTOP)

    @rule(pick=st.integers(0, 100), binding=st.sampled_from([PLAN, LIVE]))
    def entitled_command(self, pick: int, binding: Binding) -> None:
        """What the holder may do here, so that the walk gets deep."""
        if self.holder is None:
            self.lease("anna", "take")
        assert self.holder is not None
        # E-stop on one pick in ten: from everywhere it would end every walk.
        choices = [c for c in table.allowed(self.state) if c is not Command.ESTOP or pick % 10 == 0]
        bound = binding if Command.LOAD in choices else None
        self.command(choices[pick % len(choices)], self.holder, 1, False, bound)

    @rule(event=st.sampled_from([e for e in Event if e not in (Event.FAULT, Event.LINK_LOST)]))
    def expected_event(self, event: Event) -> None:
        self.event(event)

    @rule(event=st.sampled_from(list(Event)))
    def event(self, event: Event) -> None:
        target = self.expected(event)
        self.machine.event(event)
        if event is Event.LINK_LOST:
            self.linked = False
        if target is not None:
            self.state = target

    @rule(severity=st.sampled_from(list(Severity)), code=st.sampled_from(["a", "b"]))
    def alarm(self, severity: Severity, code: str) -> None:
        self.machine.alarm(code, severity, code, self.now)

    @precondition(lambda self: self.state in IN_MOTION)
    @rule()
    def silence(self) -> None:
        for event in self.machine.silence(self.now):
            target = self.expected(event)
            self.machine.event(event)
            self.state = target or self.state

    @invariant()
    def agrees(self) -> None:
        assert self.machine.state is self.state
        assert self.machine.linked == self.linked
        assert self.machine.allowed() == table.allowed(self.state)

    @invariant()
    def is_sound(self) -> None:
        machine = self.machine
        if machine.state in (State.READY, State.ARMED, *IN_MOTION):
            assert machine.binding is not None
            assert machine.binding.rig_hash == machine.rig_hash
        if machine.state in IN_MOTION:
            assert machine.moving
        first = [a for a in machine.alarms.standing if a.first]
        assert len(first) <= 1


TestModel = Model.TestCase
TestModel.settings = settings(
    max_examples=150, stateful_step_count=60, deadline=None, suppress_health_check=[HealthCheck.too_slow]
)


def test_silence_policies_must_rise() -> None:
    with pytest.raises(ValueError, match="hold_s < stop_s"):
        SilencePolicy(5.0, 5.0, 6.0)


def test_the_machine_asks_no_clock(monkeypatch: pytest.MonkeyPatch) -> None:
    def refuse() -> float:
        raise AssertionError("the machine read a clock")

    for name in ("time", "monotonic", "perf_counter"):
        monkeypatch.setattr(time, name, refuse)
    Session().to(State.HELD)
