"""The transition table: the one source of what the session may do.

Every row is one arrow of the session's diagram. The machine looks rows up and never decides by itself; the guide's
diagram and the console's enabled buttons are generated from the same rows.

`when` narrows a row: positioning for a flight and for a move are the same state with different ends; `reset` leads
back to idle only while the drive's link is up. A latched E-stop or fault is left by `reset` alone: losing the link
there is remembered (the way out then leads to disconnected), so that pulling a cable cannot clear a latch.
"""

from dataclasses import dataclass
from enum import StrEnum

from fullpose_server.session.states import Action, Command, Event, State


class When(StrEnum):
    """A condition of the machine's own memory."""

    ALWAYS = ""
    FLIGHT = "flight"  # positioning toward a flight's lead-in
    MOVE = "move"  # positioning by move, home or jog
    LINKED = "link up"
    UNLINKED = "link down"


@dataclass(frozen=True)
class Transition:
    """In any of `sources`, `trigger` leads to `target`, and `actions` are ordered, in this order."""

    sources: frozenset[State]
    trigger: Command | Event
    target: State
    actions: tuple[Action, ...] = ()
    when: When = When.ALWAYS


ANY = frozenset(State)
LATCHED = frozenset({State.ESTOPPED, State.FAULTED})


def _row(
    sources: State | frozenset[State],
    trigger: Command | Event,
    target: State,
    *actions: Action,
    when: When = When.ALWAYS,
) -> Transition:
    return Transition(frozenset({sources}) if isinstance(sources, State) else sources, trigger, target, actions, when)


S, C, V, A = State, Command, Event, Action
_FLYING = frozenset({S.POSITIONING, S.RUNNING, S.HELD})

TABLE: tuple[Transition, ...] = (
    _row(S.DISCONNECTED, C.CONNECT, S.IDLE),
    _row(S.IDLE, C.LOAD, S.READY, A.BIND),
    _row(S.READY, C.ARM, S.ARMED, A.ENABLE),
    _row(S.READY, C.UNLOAD, S.IDLE, A.UNBIND),
    _row(S.ARMED, C.START, S.POSITIONING, A.POSITION),
    _row(S.ARMED, C.MOVE, S.POSITIONING, A.MOVE),
    _row(S.ARMED, C.HOME, S.POSITIONING, A.MOVE),
    _row(S.ARMED, C.JOG, S.POSITIONING, A.MOVE),
    _row(S.ARMED, C.GO_LIVE, S.LIVE, A.GO_LIVE),
    _row(S.ARMED, C.DISARM, S.READY, A.DISABLE),
    _row(S.POSITIONING, V.AT_START, S.RUNNING, A.RUN, when=When.FLIGHT),
    _row(S.POSITIONING, V.THERE, S.ARMED, when=When.MOVE),
    _row(S.RUNNING, C.HOLD, S.HELD, A.HOLD),
    _row(S.RUNNING, V.END, S.ARMED),
    _row(S.HELD, C.RESUME, S.RUNNING, A.RESUME),
    _row(S.HELD, V.END, S.ARMED),  # hold asked so late that the path ended first
    _row(_FLYING | {S.LIVE}, C.STOP, S.STOPPING, A.BRAKE),
    _row(S.LIVE, V.SOURCE_LOST, S.STOPPING, A.BRAKE),
    _row(S.STOPPING, V.AT_REST, S.ARMED),
    _row(S.RUNNING, V.SILENT_HOLD, S.HELD, A.HOLD),
    _row(S.LIVE, V.SILENT_HOLD, S.STOPPING, A.BRAKE),  # a live source has no path to hold on
    _row(_FLYING | {S.LIVE}, V.SILENT_STOP, S.STOPPING, A.BRAKE),
    _row(S.ARMED, V.SILENT_DISARM, S.READY, A.DISABLE),
    _row(ANY - {S.ESTOPPED}, C.ESTOP, S.ESTOPPED, A.BRAKE_FASTEST, A.DISABLE_AT_REST),
    _row(ANY - LATCHED - {S.DISCONNECTED}, V.FAULT, S.FAULTED, A.BRAKE_FASTEST),
    _row(ANY - LATCHED - {S.DISCONNECTED}, V.LINK_LOST, S.DISCONNECTED, A.UNBIND),
    _row(LATCHED, C.RESET, S.IDLE, A.CLEAR, A.UNBIND, A.DISABLE, when=When.LINKED),
    _row(LATCHED, C.RESET, S.DISCONNECTED, A.CLEAR, A.UNBIND, when=When.UNLINKED),
)

# Alarms can be acknowledged and shelved wherever the session stands; the state does not change.
ANYWHERE = frozenset({Command.ACKNOWLEDGE, Command.SHELVE, Command.UNSHELVE})


def find(state: State, trigger: Command | Event, holding: frozenset[When]) -> Transition | None:
    """The row for `trigger` in `state`, of those whose condition is among `holding`; None where there is none."""
    for row in TABLE:
        if row.trigger == trigger and state in row.sources and (row.when is When.ALWAYS or row.when in holding):
            return row
    return None


def allowed(state: State) -> tuple[Command, ...]:
    """The commands that `state` accepts, in the order of `Command`."""
    return tuple(c for c in Command if c in ANYWHERE or any(r.trigger == c and state in r.sources for r in TABLE))
