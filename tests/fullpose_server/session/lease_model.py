"""The part of the session's model that is about time and the lease; `test_model` has the rest."""

from hypothesis import strategies as st
from hypothesis.stateful import RuleBasedStateMachine, rule

from fullpose_server.session.alarms import Alarm
from fullpose_server.session.binding import Binding
from fullpose_server.session.errors import (
    LeaseError,
)
from fullpose_server.session.machine import SessionMachine, SilencePolicy
from fullpose_server.session.states import Event, State

S = State
RIG = ("rig", "a" * 64)
STAGES = ((5.0, Event.SILENT_HOLD), (15.0, Event.SILENT_STOP), (60.0, Event.SILENT_DISARM))
SILENT_S = STAGES[0][0]
PEOPLE = st.sampled_from(["anna", "bert"])


class LeaseModel(RuleBasedStateMachine):
    """What a session knows, as the model has it; time and leases at random, foretold before they act."""

    def __init__(self) -> None:
        super().__init__()
        self.machine: SessionMachine[str, str] = SessionMachine(*RIG, SilencePolicy(*(limit for limit, _ in STAGES)))
        self.now = 0.0
        self.state = S.DISCONNECTED
        self.revision = 0
        self.bound: Binding | None = None
        self.linked = self.moving = self.flight = False
        self.holder: str | None = None
        self.epoch = self.sequence = self.stage = 0
        self.heard = 0.0
        self.asked: list[str] = []
        self.standing: list[Alarm] = []
        self.shelves: dict[str, float] = {}  # until when [s], by the code
        self.past: dict[int, Alarm] = {}

    # --- time and silence ---

    @rule(seconds=st.sampled_from([0.0, 1.0, 5.5, 15.5, 61.0]) | st.floats(0.0, 70.0), ask=st.booleans())
    def pass_time(self, seconds: float, ask: bool) -> None:
        self.now += seconds
        if ask:
            self.silence()

    def silence(self) -> None:
        """What is due by the time nobody who holds the lease was heard, and what comes of it."""
        silent = self.now - self.heard
        reached = sum(silent > limit for limit, _ in STAGES)
        due = tuple(event for _, event in STAGES[self.stage : reached])
        self.stage = max(self.stage, reached) if reached else 0
        assert self.machine.silence(self.now) == due
        for event in due:
            self.event(event)

    # --- the lease ---

    @rule(action=st.sampled_from(["take", "takeover", "release", "renew", "request", "grant"]), who=PEOPLE)
    def lease(self, action: str, who: str) -> None:
        code = self.lease_refusal(action, who)
        before = vars(self.machine).copy()
        try:
            self.machine.lease_action(action, who, self.now)
        except LeaseError as refusal:
            assert refusal.code == code  # noqa: PT017
            assert vars(self.machine) == before
            return
        assert code is None
        if action == "request":
            if who not in (self.holder, *self.asked):
                self.asked.append(who)
                self.revision += 1
            return
        self.heard = self.now
        if action == "grant":
            self.hand_to(self.asked[0])
        elif action == "release":
            self.hand_to(None)
        elif action != "renew" and self.holder != who:
            self.hand_to(who)

    def lease_refusal(self, action: str, who: str) -> str | None:
        if action == "take":
            in_use = self.holder not in (None, who) and self.now - self.heard <= SILENT_S
            return "lease_held" if in_use else None
        if action == "request":
            return "lease_free" if self.holder is None else None
        if action != "takeover" and self.holder != who:
            return "lease_lost"
        return "lease_not_requested" if action == "grant" and not self.asked else None

    def hand_to(self, who: str | None) -> None:
        self.holder, self.epoch, self.sequence = who, self.epoch + 1, 0
        self.asked = [name for name in self.asked if name != who]
        self.revision += 1

    def event(self, event: Event) -> None:
        """Report `event`, and what is to come of it."""
        raise NotImplementedError
