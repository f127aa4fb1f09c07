"""What a drive is: the one interface between the loop and a table's servo electronics.

The loop calls `read`, then `write`, once a tick, and nothing else while the rig moves; neither may block. One call
alone comes from another thread: `emergency_brake`, where the loop's own does not return. Every driver must have a
watchdog: where writes stop, the table brakes by itself, because nobody else is left to do it.
Units are radians and seconds; arrays are (4,), base first; a frame the rig has not is zero.
"""

from enum import IntFlag
from typing import Any, Protocol

from fullpose._typing import Array
from fullpose.rig import Rig


class DriveError(Exception):
    """The drive cannot do what was asked: what, why, and what to look at. Never raised by `read` or `write`."""


class Status(IntFlag):
    """What `read` found."""

    OK = 0
    ENABLED = 1  # follows commands
    BRAKING = 2  # brakes by itself, or holds by its brakes
    WATCHDOG = 4  # began to brake because writes stopped
    FAULT = 8  # the drive reports a fault of its own
    ENCODER = 16  # a position cannot be trusted; it is nan
    LINK_LOST = 32  # no word from the table: the arrays are left as they were
    STALE_WRITE = 64  # refused a write of an older epoch or series, or out of sequence
    UNCONFIRMED = 128  # the last enable, brake or disable is on its way: the table has not said yet that it took it


class Drive(Protocol):
    """A table's servo electronics."""

    name: str

    def connect(self, now: float) -> None:
        """Open the link; `now` [s, monotonic]. May block for a second. Raises `DriveError`."""
        ...

    def enable(self) -> None:
        """Release the brakes and follow writes from the present position; their sequence begins anew.

        May return before the table has heard of it: until then `read` reports `UNCONFIRMED`, and nothing of a time
        before (no `ENABLED`, no `WATCHDOG`). Like `brake` and `disable` it is repeated until it arrives.
        Raises `DriveError`.
        """
        ...

    def read(self, now: float, position: Array, rate: Array) -> int:
        """Fill the measured position [rad] and rate [rad/s] in place; returns `Status` bits."""
        ...

    def write(self, position: Array, rate: Array, acceleration: Array, epoch: int, sequence: int) -> None:
        """Demand for the next tick. `epoch` is the lease's, `sequence` grows with each write; old ones are refused."""
        ...

    def brake(self) -> None:
        """Brake at once, by the drive's own means, whatever is written; left by `enable`."""
        ...

    def emergency_brake(self) -> None:
        """`brake`, from another thread, while a call of the loop's thread does not return, whichever it is.

        It waits for nothing that such a call may hold: no lock, no queue, no answer. The table brakes on, whatever the
        hung call does when it comes to itself; left by `enable`.
        """
        ...

    def disable(self) -> None:
        """Power off: brakes hold. Safe at any time."""
        ...

    def close(self) -> None:
        """Close the link; the table brakes."""
        ...


class DriveFactory(Protocol):
    """What an entry point of the group `fullpose.drives` must be."""

    def __call__(self, rig: Rig, rate_hz: float, options: dict[str, Any]) -> Drive:
        """Make an unconnected drive. Raises `DriveError` on options it does not know."""
        ...
