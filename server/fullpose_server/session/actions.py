"""What the machine orders, each order with its arguments; the rig process's executor does all of them.

The table names an order by its word (`states.Action`); what it needs was prepared by the caller (`Given`) before the
machine decided. The machine knows neither what a load is made of (L) nor a move (M): it hands them on.
"""

from dataclasses import dataclass
from typing import ClassVar, Generic, TypeAlias, TypeVar

from fullpose_server.session.alarms import Shelf
from fullpose_server.session.binding import Binding
from fullpose_server.session.errors import NotReadyError
from fullpose_server.session.states import Action

L = TypeVar("L")
M = TypeVar("M")


@dataclass(frozen=True)
class Given(Generic[L, M]):
    """What goes with a command, made ready: what `load` binds, the move of move, home, jog and start.

    `binding` goes with arm too, where the caller names the pair. `alarms` are the numbers that `acknowledge` is about
    (None: all) and `time_s` [s, Unix] is when; `shelf` is what `shelve` puts up and `unshelve` takes away, by its code
    and frame.
    """

    binding: Binding | None = None
    load: L | None = None
    move: M | None = None
    alarms: frozenset[int] | None = None
    time_s: float | None = None
    shelf: Shelf | None = None


@dataclass(frozen=True)
class Bind(Generic[L]):
    """Bind plan and rig."""

    word: ClassVar = Action.BIND
    binding: Binding
    load: L


@dataclass(frozen=True)
class Position(Generic[M]):
    """Move to where the lead-in starts; a flight of `who` begins."""

    word: ClassVar = Action.POSITION
    move: M
    who: str


@dataclass(frozen=True)
class Move(Generic[M]):
    """Make a move."""

    word: ClassVar = Action.MOVE
    move: M


@dataclass(frozen=True)
class GoLive:
    """Follow the live source; a flight of `who` begins."""

    word: ClassVar = Action.GO_LIVE
    who: str


@dataclass(frozen=True)
class Enable:
    """Enable the drive."""

    word: ClassVar = Action.ENABLE


@dataclass(frozen=True)
class Disable:
    """Disable the drive."""

    word: ClassVar = Action.DISABLE


@dataclass(frozen=True)
class Unbind:
    """Forget plan or live source."""

    word: ClassVar = Action.UNBIND


@dataclass(frozen=True)
class Run:
    """Run the path."""

    word: ClassVar = Action.RUN


@dataclass(frozen=True)
class Hold:
    """Hold on the path."""

    word: ClassVar = Action.HOLD


@dataclass(frozen=True)
class Resume:
    """Resume on the path."""

    word: ClassVar = Action.RESUME


@dataclass(frozen=True)
class Brake:
    """Brake inside the limits."""

    word: ClassVar = Action.BRAKE


@dataclass(frozen=True)
class BrakeFastest:
    """Brake as fast as the limits allow."""

    word: ClassVar = Action.BRAKE_FASTEST


@dataclass(frozen=True)
class DisableAtRest:
    """Disable the drive at rest."""

    word: ClassVar = Action.DISABLE_AT_REST


@dataclass(frozen=True)
class Clear:
    """Clear the alarms."""

    word: ClassVar = Action.CLEAR


Order: TypeAlias = (
    Bind[L]
    | Position[M]
    | Move[M]
    | GoLive
    | Enable
    | Disable
    | Unbind
    | Run
    | Hold
    | Resume
    | Brake
    | BrakeFastest
    | DisableAtRest
    | Clear
)
_BARE: dict[Action, Enable | Disable | Unbind | Run | Hold | Resume | Brake | BrakeFastest | DisableAtRest | Clear] = {
    made.word: made
    for made in (
        Enable(),
        Disable(),
        Unbind(),
        Run(),
        Hold(),
        Resume(),
        Brake(),
        BrakeFastest(),
        DisableAtRest(),
        Clear(),
    )
}


def order_of(word: Action, given: Given[L, M], who: str) -> Order[L, M]:
    """The order that `word` names, with its arguments of `given`. Raises `NotReadyError` where they are missing."""
    match word:
        case Action.BIND:
            if given.binding is None or given.load is None:
                raise NotReadyError("nothing_to_load", "load needs a plan folder or a live source")
            return Bind(given.binding, given.load)
        case Action.POSITION | Action.MOVE:
            if given.move is None:
                raise NotReadyError("no_move", "this command needs a move that was made ready")
            return Move(given.move) if word is Action.MOVE else Position(given.move, who)
        case Action.GO_LIVE:
            return GoLive(who)
        case _:
            return _BARE[word]
