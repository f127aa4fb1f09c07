"""Thousands of random steps of the machine against a model of it, built from the table and the guide's rules.

The model foretells everything: of a command the orders or the exact refusal (stop and E-stop never want a lease), of
silence the stages due, of an alarm its number, count and place. After each step machine and model agree in all they
show.
"""

import dataclasses
import random

from hypothesis import HealthCheck, settings
from hypothesis import strategies as st
from hypothesis.stateful import invariant, rule

from fullpose_server.session import table
from fullpose_server.session.actions import Bind, Given, GoLive, Move, Order, Position
from fullpose_server.session.alarms import HISTORY, Alarm, Severity, Shelf
from fullpose_server.session.binding import Binding
from fullpose_server.session.errors import (
    BindingError,
    IllegalCommandError,
    LeaseError,
    NotReadyError,
    SessionError,
)
from fullpose_server.session.lease import Lease, LeaseAction, LeaseToken
from fullpose_server.session.states import Command, Event, State
from fullpose_server.session.table import When
from tests.fullpose_server.session.lease_model import PEOPLE, RIG, SHOWN, SILENT_S, LeaseModel

C, S = Command, State
ACK = C.ACKNOWLEDGE
PLAN = Binding("p", "b" * 64, *RIG)
LIVE = Binding("live", "c" * 64, *RIG, live=True)
OTHER_PLAN = dataclasses.replace(PLAN, plan_hash="9" * 64)
OTHER_RIG = dataclasses.replace(PLAN, rig_hash="d" * 64)
FREE = (C.STOP, C.ESTOP)
SHELVES = (C.SHELVE, C.UNSHELVE)
LATCHED = (S.ESTOPPED, S.FAULTED)
MOVING = (S.POSITIONING, S.RUNNING, S.HELD, S.STOPPING, S.LIVE)
SELDOM: tuple[Command | Event, ...] = (
    C.ESTOP,
    Event.FAULT,
    Event.LINK_LOST,
)  # from almost everywhere: they would end every walk
FLIGHT = (C.CONNECT, C.LOAD, C.ARM, C.START, Event.AT_START, C.HOLD, C.RESUME, Event.AT_REST)
# Tokens, counted from the lease's epoch and newest sequence.
TOKENS = ((0, 1), (0, 1), (0, 1), (0, 5), (0, 0), (0, -1), (-1, 1), (1, 1), None)
Refusal = tuple[type[SessionError], str]


LOAD, MOVE = "a load", "a move"


class Model(LeaseModel):
    """Commands, events, leases, alarms and time at random; every rule foretells before it acts."""

    # --- commands ---

    def rows(self) -> list[table.Transition]:
        """What the table has for the present state."""
        holding = (
            When.ALWAYS,
            When.FLIGHT if self.flight else When.MOVE,
            When.LINKED if self.linked else When.UNLINKED,
        )
        return [r for r in table.TABLE if self.state in r.sources and r.when in holding]

    def row(self, trigger: Command | Event) -> table.Transition | None:
        rows = [r for r in self.rows() if r.trigger == trigger]
        assert len(rows) <= 1
        return rows[0] if rows else None

    def command_refusal(self, command: Command, token: LeaseToken | None, given: Given[str, str]) -> Refusal | None:
        """What is to be raised, and its code; None where the command is to be done."""
        binding = given.binding
        if command not in FREE:
            if token is None or self.holder is None:
                return LeaseError, "lease_needed"
            if token.proof != self.proof or token.epoch != self.epoch:
                return LeaseError, "lease_lost"
            if token.sequence <= self.sequence:
                return LeaseError, "stale_command"
        if command not in (ACK, *SHELVES) and self.row(command) is None:
            return IllegalCommandError, "illegal_command"
        live = self.bound is not None and self.bound.live
        unseen = any(a.severity is not Severity.WARNING and a.acknowledged_by is None for a in self.standing)
        if (command is C.START and live) or (command is C.GO_LIVE and not live):
            return NotReadyError, "wrong_load"
        if command is C.ARM and unseen:
            return NotReadyError, "standing_fault"
        if command is C.RESET and self.moving:
            return NotReadyError, "not_at_rest"
        if command is C.RESET and unseen:
            return NotReadyError, "unacknowledged"
        if command is C.LOAD and binding is None:
            return NotReadyError, "nothing_to_load"
        if command is C.LOAD and binding is OTHER_RIG:
            return BindingError, "wrong_pair"
        if command is C.ARM and binding is not None:
            assert self.bound is not None
            same = (binding.plan_hash, binding.rig_hash) == (self.bound.plan_hash, self.bound.rig_hash)
            return None if same else (BindingError, "wrong_pair")
        if command in SHELVES and given.shelf is None:
            return NotReadyError, "nothing_to_shelve"
        return None

    @rule(
        command=st.sampled_from(list(Command)),
        who=PEOPLE,
        shown=st.sampled_from(TOKENS),
        secret=SHOWN,
        binding=st.sampled_from([None, PLAN, LIVE, OTHER_PLAN, OTHER_RIG]),
        numbers=st.none() | st.frozensets(st.integers(1, 8)),
        shelved=st.none() | st.tuples(st.sampled_from(["a", "b"]), st.floats(1.0, 60.0)),
    )
    def command(
        self,
        command: Command,
        who: str,
        shown: tuple[int, int] | None,
        binding: Binding | None,
        numbers: frozenset[int] | None,
        shelved: tuple[str, float] | None = None,
        secret: str | None = "held",
    ) -> None:
        proof = self.shown(secret)
        token = None
        if shown is not None and proof is not None:
            token = LeaseToken(self.epoch + shown[0], self.sequence + shown[1], proof)
        shelf = None if shelved is None else Shelf(shelved[0], None, self.now, self.now + shelved[1], who)
        made_ready = Given(binding, LOAD, MOVE, numbers, shelf=shelf)
        expected = self.command_refusal(command, token, made_ready)
        self.commander = who
        before = vars(self.machine).copy()
        actions: tuple[Order[str, str], ...] = ()
        given: Refusal | None = None
        try:
            actions = self.machine.command(command, who, token, self.now, made_ready)
        except SessionError as refusal:
            given = (type(refusal), refusal.code)
        assert given == expected, command
        if given is not None:
            assert vars(self.machine) == before
            return
        if command not in FREE:
            assert token is not None
            self.sequence, self.heard = token.sequence, self.now
        if command is ACK:
            assert actions == ()
            self.revision += 1
            self.acknowledge(who, numbers)
            return
        if shelf is not None and command in SHELVES:
            assert actions == ()
            self.revision += 1
            self.shelves.pop(shelf.code, None)
            if command is C.SHELVE:
                self.shelves[shelf.code] = shelf.until_s
                warnings = (shelf.code, Severity.WARNING)
                self.standing = [a for a in self.standing if (a.code, a.severity) != warnings]
            return
        row = self.row(command)
        assert row is not None
        if command is C.LOAD:
            self.bound = binding
        self.linked = self.linked or command is C.CONNECT
        self.chained = self.chained and command is not C.CONNECT
        if command in (C.START, C.MOVE, C.HOME, C.JOG):
            self.flight = command is C.START
        self.go(row, actions)
        if command is C.RESET:
            self.standing = [a for a in self.standing if a.acknowledged_by is None]
            self.await_first()

    @rule(seed=st.integers(0, 2**32 - 1), binding=st.sampled_from([PLAN, LIVE]))
    def walk(self, seed: int, binding: Binding) -> None:
        """Along the table's arrows, from wherever the session is; by even chances, so that it gets everywhere."""
        chance = random.Random(seed)
        for _ in range(20):
            steps: list[Command | Event] = [ACK, *(row.trigger for row in self.rows() if row.trigger not in SELDOM)]
            if chance.random() < 0.05:
                steps = list(SELDOM)
            elif chance.random() < 0.5:  # toward a flight: evenly chosen steps hardly ever come that far
                steps = [step for step in steps if step in FLIGHT] or steps
            step = chance.choice(steps)
            if step is C.RESET:
                if chance.random() < 0.8:
                    self.event(Event.AT_REST)
                if chance.random() < 0.8:
                    self.say(ACK)
                self.say(C.RESET)
            elif isinstance(step, Event):
                self.event(step)
            else:
                self.say(step, binding)

    def say(self, command: Command, binding: Binding | None = None) -> None:
        if self.holder is None:
            self.lease(LeaseAction.TAKE, "anna")
        assert self.holder is not None
        self.command(command, self.holder, (0, 1), binding if command is C.LOAD else None, None)

    # --- what happens ---

    @rule(event=st.sampled_from([*Event, *(e for e in Event if e not in SELDOM)]))
    def event(self, event: Event) -> None:
        if event is Event.AT_REST and self.state in LATCHED:
            self.moving = False
        if event is Event.LINK_LOST:
            self.linked = self.moving = False
        row = self.row(event)
        actions = self.machine.event(event)
        if row is None:
            assert actions == ()
        else:
            self.go(row, actions)

    def go(self, row: table.Transition, actions: tuple[Order[str, str], ...]) -> None:
        assert tuple(order.word for order in actions) == row.actions
        for order in actions:
            match order:
                case Bind():
                    assert (order.binding, order.load) == (self.bound, LOAD)
                case Position():
                    assert (order.move, order.who) == (MOVE, self.commander)
                case Move():
                    assert order.move is MOVE
                case GoLive():
                    assert order.who == self.commander
        self.state = row.target
        self.revision += 1
        if self.state not in LATCHED:
            self.moving = self.state in MOVING
        if self.state in (S.IDLE, S.DISCONNECTED):
            self.bound = None

    # --- alarms ---

    @rule(severity=st.sampled_from(list(Severity)), code=st.sampled_from(["a", "b"]))
    def alarm(self, severity: Severity, code: str) -> None:
        lasting = {shelved: until_s for shelved, until_s in self.shelves.items() if self.now < until_s}
        self.revision += lasting != self.shelves
        self.shelves = lasting
        self.machine.end_shelves(self.now)
        if severity is Severity.WARNING and code in self.shelves:
            before = [a for a in self.past.values() if a.shelved and a.code == code]
            if before:
                expected = dataclasses.replace(before[-1], count=before[-1].count + 1, last_time_s=self.now)
            else:
                expected = Alarm(len(self.past) + 1, code, severity, "told", self.now, shelved=True)
            self.past[expected.number] = expected
            self.revision += 1
            assert self.machine.alarm(code, severity, "told", self.now) == expected
            return
        again = [a for a in self.standing if (a.code, a.severity, a.acknowledged_by) == (code, severity, None)]
        first = severity is not Severity.WARNING and not self.chained
        self.chained = self.chained or first
        if again:
            count, marked = again[0].count + 1, again[0].first or first
            expected = dataclasses.replace(again[0], count=count, last_time_s=self.now, first=marked)
            self.standing[self.standing.index(again[0])] = expected
            self.past[expected.number] = expected
        else:
            expected = Alarm(len(self.past) + 1, code, severity, "told", self.now, first=first)
            self.standing.append(expected)
            self.past[expected.number] = expected
        self.revision += 1
        assert self.machine.alarm(code, severity, "told", self.now) == expected

    def acknowledge(self, who: str, numbers: frozenset[int] | None) -> None:
        still = []
        for alarm in self.standing:
            seen = alarm
            if alarm.acknowledged_by is None and (numbers is None or alarm.number in numbers):
                seen = dataclasses.replace(alarm, acknowledged_by=who)
            self.past[alarm.number] = seen
            # Seen warnings leave at once; seen faults too, where no latch waits for its reset.
            leaves = alarm.severity is Severity.WARNING or self.state not in LATCHED
            if seen.acknowledged_by is None or not leaves:
                still.append(seen)
        self.standing = still
        if self.state not in LATCHED:
            self.await_first()

    def await_first(self) -> None:
        """A chain of faults ends with the last of them that stands."""
        self.chained = self.chained and any(a.severity is not Severity.WARNING for a in self.standing)

    # --- what must hold ---

    @invariant()
    def agrees(self) -> None:
        machine = self.machine
        assert machine.state is self.state
        assert machine.revision == self.revision
        assert (machine.linked, machine.moving) == (self.linked, self.moving)
        assert machine.binding == self.bound
        assert machine.allowed() == table.allowed(self.state)
        assert list(machine.alarms.standing) == self.standing
        past = {number: alarm for number, alarm in self.past.items() if number > len(self.past) - HISTORY}
        assert {alarm.number: alarm for alarm in machine.alarms.history} == past
        left = None if self.holder is None else max(0.0, self.heard + SILENT_S - self.now)
        lease = Lease(self.holder, self.epoch, left, self.sequence, tuple(self.asked))
        assert machine.lease(self.now) == lease
        assert not any(proof in repr(vars(machine)) for proof in self.known())

    @invariant()
    def is_sound(self) -> None:
        machine = self.machine
        if machine.state in (S.READY, S.ARMED, *MOVING):
            assert machine.binding is not None
            assert machine.binding.rig_hash == machine.rig_hash
        faults = [alarm for alarm in machine.alarms.standing if alarm.severity is not Severity.WARNING]
        assert not faults or any(alarm.first for alarm in faults)  # a chain without its cause tells nothing


TestModel = Model.TestCase
TestModel.settings = settings(
    max_examples=100, stateful_step_count=50, deadline=None, suppress_health_check=[HealthCheck.too_slow]
)
