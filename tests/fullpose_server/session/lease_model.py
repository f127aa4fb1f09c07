"""The part of the session's model that is about time and the lease; `test_model` has the rest."""

import pytest
from hypothesis import strategies as st
from hypothesis.stateful import RuleBasedStateMachine, rule

from fullpose_server.secret import proof_of
from fullpose_server.session.alarms import Alarm
from fullpose_server.session.binding import Binding
from fullpose_server.session.errors import (
    LeaseError,
)
from fullpose_server.session.lease import GIVES_SECRET, LeaseAction
from fullpose_server.session.machine import SessionMachine, SilencePolicy
from fullpose_server.session.states import Event, State

S = State
RIG = ("rig", "a" * 64)
STAGES = ((5.0, Event.SILENT_HOLD), (15.0, Event.SILENT_STOP), (60.0, Event.SILENT_DISARM))
SILENT_S = STAGES[0][0]
PEOPLE = st.sampled_from(["anna", "bert"])
SHOWN = st.sampled_from(["held", "held", "held", "former", "asked", "guessed", None])


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
        self.asked: dict[str, str] = {}  # who asked, first first: the proof of the secret that is to be theirs
        self.proof: str | None = None  # of the holder's secret
        self.former: list[str] = []  # of secrets that hold no more
        self.secrets = 0
        self.commander = ""  # who gave the newest command
        self.standing: list[Alarm] = []
        self.chained = False  # the chain of faults has its first
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

    @rule(action=st.sampled_from(list(LeaseAction)), who=PEOPLE, shown=SHOWN)
    def lease(self, action: LeaseAction, who: str, shown: str | None = "held") -> None:
        proof = self.fresh() if action in GIVES_SECRET and shown is not None else self.shown(shown)
        code = self.lease_refusal(action, proof)
        if code is not None:
            before = vars(self.machine).copy()
            with pytest.raises(LeaseError) as refused:
                self.machine.lease_action(action, who, self.now, proof)
            assert refused.value.code == code
            assert not any(known in str(refused.value) for known in self.known())
            assert vars(self.machine) == before
            return
        self.machine.lease_action(action, who, self.now, proof)
        assert proof is not None
        if action is LeaseAction.REQUEST:
            self.asked[who] = proof
            self.revision += 1
            return
        self.heard = self.now
        if action is LeaseAction.GRANT:
            self.hand_to(*next(iter(self.asked.items())))
        elif action is LeaseAction.RELEASE:
            self.hand_to(None, None)
        elif action is not LeaseAction.RENEW:
            self.hand_to(who, proof)

    def fresh(self) -> str:
        self.secrets += 1
        return proof_of(f"secret {self.secrets}")

    def shown(self, which: str | None) -> str | None:
        """The proof that somebody shows: of the holder's secret, of an earlier one, of one that was not granted."""
        match which:
            case "held":
                return self.proof or proof_of("nobody's")
            case "former":
                return self.former[-1] if self.former else proof_of("nobody's")
            case "asked":
                return next(iter(self.asked.values()), proof_of("nobody's"))
            case "guessed":
                return ""
            case _:
                return None

    def known(self) -> list[str]:
        """Every proof there was."""
        return [*self.former, *self.asked.values(), *([] if self.proof is None else [self.proof])]

    def lease_refusal(self, action: LeaseAction, proof: str | None) -> str | None:
        if proof is None:
            return "lease_needed"
        if action is LeaseAction.TAKE:
            in_use = self.holder is not None and self.now - self.heard <= SILENT_S
            return "lease_held" if in_use else None
        if action is LeaseAction.REQUEST:
            return "lease_free" if self.holder is None else None
        if action is LeaseAction.TAKEOVER:
            return None
        if self.holder is None:
            return "lease_needed"
        if proof != self.proof:
            return "lease_lost"
        return "lease_not_requested" if action is LeaseAction.GRANT and not self.asked else None

    def hand_to(self, who: str | None, proof: str | None) -> None:
        if self.proof is not None:
            self.former.append(self.proof)
        self.holder, self.proof, self.epoch, self.sequence = who, proof, self.epoch + 1, 0
        if who is not None:
            self.asked.pop(who, None)
        self.revision += 1

    def event(self, event: Event) -> None:
        """Report `event`, and what is to come of it."""
        raise NotImplementedError
