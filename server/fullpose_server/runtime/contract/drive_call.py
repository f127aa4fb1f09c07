"""The call of its drive that a loop is in, marked in the shared memory for who watches the loop from outside.

The loop marks it before the call and takes the mark away after it: one that stays is a drive that hangs.
"""

from datetime import UTC, datetime
from enum import IntEnum
from typing import Any, NamedTuple

from numpy.typing import NDArray

HANGS = "drive_hangs"  # code of its alarm
EXIT_HANGS = 3  # of a rig process that ended because its drive did not let go of it


class DriveCall(IntEnum):
    """What the loop asks of its drive (see `drives.base.Drive`)."""

    NONE = 0
    CONNECT = 1
    ENABLE = 2
    READ = 3
    WRITE = 4
    BRAKE = 5
    DISABLE = 6
    CLOSE = 7

    @property
    def word(self) -> str:
        """As it is written in the drive's interface."""
        return self.name.lower()


PATIENT = frozenset({DriveCall.CONNECT, DriveCall.CLOSE})  # they may wait for a table


class Pending(NamedTuple):
    """A call that has not returned."""

    call: DriveCall
    since_ns: int  # monotonic


def pending(header: NDArray[Any]) -> Pending | None:
    """The call that the loop is in, by the shared memory's `header`; None where it is in none."""
    call = int(header["drive_call"][0])
    return Pending(DriveCall(call), int(header["drive_call_ns"][0])) if call else None


def hanging(drive: str, call: Pending, now_ns: int, wall_ns: int) -> str:
    """What is said of a call that does not return: drive, call, for how long and since when."""
    for_ns = now_ns - call.since_ns
    since = datetime.fromtimestamp((wall_ns - for_ns) / 1e9, UTC)
    return f"drive {drive}: {call.call.word} has not returned for {for_ns / 1e6:.0f} ms, since {since:%H:%M:%S.%f} UTC"
