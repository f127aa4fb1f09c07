"""The drive as the loop calls it: each call is marked for who watches it, timed, and its errors are caught and named.

Who writes the shared memory and moves the session is one thread at a time, by a lock that the loop holds except while
it is in a call of the drive: there the watch may take it, and the loop waits with the call's return until it is back.
"""

import logging
import math
import threading
from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from fullpose._typing import Array
from fullpose_server.drives.base import Drive, DriveError, Status
from fullpose_server.runtime.contract.drive_call import DriveCall, Pending, pending
from fullpose_server.runtime.loop.clock import Clock

log = logging.getLogger("fullpose.rig")
_FAULT = int(Status.FAULT)
_LONGEST = 300
_ERRORS = (Exception, SystemExit, KeyboardInterrupt)  # a driver that ends the program ends no loop


class DriveFailure(NamedTuple):
    """A call that raised what it may not."""

    call: DriveCall
    took_ns: int
    cause: str


class WatchedDrive:
    """A `Drive` around a drive, for one loop. `header` is the shared memory's.

    What the drive raises is logged with its traceback; of `connect` and `enable` it becomes a `DriveError`, of the
    others `failure`: once, however often the call fails until it succeeds again.
    """

    def __init__(self, drive: Drive, header: NDArray[np.void], clock: Clock) -> None:
        self.name = drive.name
        self.read_ns = 0  # of the newest read
        self.write_ns: int | None = None  # of the write since that read, where there was one
        self._drive = drive
        self._clock = clock
        self._header = header
        self._call, self._since = header["drive_call"], header["drive_call_ns"]
        self._turn = threading.Lock()
        self._turn.acquire()
        self._number = 0  # of the newest call
        self._returned = False  # the loop waits for its turn
        self._taken = False  # by the watch
        self._owed: DriveCall | None = None  # what the watch's thread would have asked of a drive that hung
        self._failure: DriveFailure | None = None
        self._failing: set[DriveCall] = set()
        self._lend()

    # --- as the loop calls it ---

    def connect(self, now: float) -> None:
        """See `Drive`. Raises `DriveError`, with the time it took."""
        self._failing.clear()
        self._failure = None
        self._may_refuse(DriveCall.CONNECT, lambda: self._drive.connect(now))

    def enable(self) -> None:
        """See `Drive`. Raises `DriveError`, with the time it took."""
        if self._taken:
            raise DriveError(f"drive {self.name} does not return from an earlier call")
        self._may_refuse(DriveCall.ENABLE, self._drive.enable)

    def read(self, now: float, position: Array, rate: Array) -> int:
        """See `Drive`; of one that raises: nothing is known, and a fault."""
        self.write_ns = None
        begun = self._begin(DriveCall.READ)
        try:
            self._position[:], self._rate[:] = position, rate
            status = _bits(self._drive.read(now, self._position, self._rate))
            position[:], rate[:] = self._position, self._rate
        except _ERRORS as cause:  # a driver's errors are its own; the loop goes on to brake
            self._fails(DriveCall.READ, begun, cause)
            position.fill(math.nan)
            rate.fill(math.nan)
            return _FAULT
        else:
            self._failing.discard(DriveCall.READ)
            return status
        finally:
            self.read_ns = self._end(begun)
            _measured(self._header, "read", self.read_ns)

    def write(self, position: Array, rate: Array, acceleration: Array, epoch: int, sequence: int) -> None:
        """See `Drive`."""
        begun = self._begin(DriveCall.WRITE)
        try:
            demand, demand_rate, demand_acceleration = self._demand
            demand[:], demand_rate[:], demand_acceleration[:] = position, rate, acceleration
            self._drive.write(demand, demand_rate, demand_acceleration, epoch, sequence)
            self._failing.discard(DriveCall.WRITE)
        except _ERRORS as cause:
            self._fails(DriveCall.WRITE, begun, cause)
        finally:
            self.write_ns = self._end(begun)
            _measured(self._header, "write", self.write_ns)

    def brake(self) -> None:
        """See `Drive`."""
        self._order(DriveCall.BRAKE)

    def disable(self) -> None:
        """See `Drive`."""
        self._order(DriveCall.DISABLE)

    def close(self) -> None:
        """See `Drive`."""
        self._order(DriveCall.CLOSE)

    def emergency_brake(self) -> None:
        """See `Drive`: past all of this."""
        self._drive.emergency_brake()

    def failure(self) -> DriveFailure | None:
        """The call that raised since this was asked last."""
        found, self._failure = self._failure, None
        return found

    # --- as it is watched, from another thread ---

    @property
    def call(self) -> DriveCall:
        """The call that the loop is in."""
        return DriveCall(int(self._call[0]))

    def in_call(self) -> int:
        """The number of the call that the loop is in; 0: it is in none."""
        return self._number if self._call[0] else 0

    def take(self, number: int) -> Pending | None:
        """Take the turn from a loop that hangs in this call: which it is; None where it is back."""
        if not self._turn.acquire(blocking=False):
            return None
        call = pending(self._header)
        if call is None or self._number != number or self._returned:
            self._turn.release()
            return None
        self._taken = True
        for_ns = self._clock.monotonic_ns() - call.since_ns
        if call.call is DriveCall.READ:
            self.read_ns = for_ns
        elif call.call is DriveCall.WRITE:
            self.write_ns = for_ns
        return call

    def give_back(self) -> bool:
        """Give the turn back where the call has returned: whether it has."""
        if self._returned:
            self._taken = False
            self._turn.release()
        return self._returned

    # --- inside ---

    def _begin(self, call: DriveCall) -> int:
        begun = self._clock.monotonic_ns()
        self._number += 1
        self._returned = False
        self._since[0] = begun
        self._call[0] = call
        self._turn.release()
        return begun

    def _end(self, begun: int) -> int:
        """The call has returned: how long it took [ns]."""
        took = self._clock.monotonic_ns() - begun
        self._returned = True
        self._turn.acquire()
        self._call[0] = 0
        owed, self._owed = self._owed, None
        if owed is not None:
            self._order(owed)
        return took

    def _may_refuse(self, call: DriveCall, ask: Callable[[], None]) -> None:
        begun = self._begin(call)
        try:
            ask()
        except DriveError as cause:
            raise DriveError(f"{cause} ({call.word} took {self._took(begun):.3g} ms)") from cause
        except _ERRORS as cause:
            raise DriveError(self._told(call, begun, cause)) from cause
        finally:
            self._end(begun)

    def _order(self, call: DriveCall) -> None:
        if self._taken:
            self._owed = call
            return
        order = {
            DriveCall.BRAKE: self._drive.brake,
            DriveCall.DISABLE: self._drive.disable,
            DriveCall.CLOSE: self._drive.close,
        }[call]
        begun = self._begin(call)
        try:
            order()
            self._failing.discard(call)
        except _ERRORS as cause:
            self._fails(call, begun, cause)
        finally:
            self._end(begun)

    def _lend(self) -> None:
        """Arrays of the drive's own: what it does to them, later or to their shape, does nothing to the loop's."""
        self._position, self._rate, *self._demand = np.zeros((5, 4))

    def _fails(self, call: DriveCall, begun: int, cause: BaseException) -> None:
        self._lend()
        if call in self._failing:
            return
        self._failing.add(call)
        took = self._clock.monotonic_ns() - begun
        self._failure = DriveFailure(call, took, self._told(call, begun, cause))

    def _told(self, call: DriveCall, begun: int, cause: BaseException) -> str:
        """What is said of it; its traceback is in the log."""
        text = f"drive {self.name}: {call.word} raised {_words(cause)} (after {self._took(begun):.3g} ms)"
        log.error("%s", text, exc_info=cause)
        return text

    def _took(self, begun: int) -> float:
        """[ms]."""
        return (self._clock.monotonic_ns() - begun) / 1e6


def _bits(status: object) -> int:
    """What `read` returned. Raises TypeError where it is no number of bits."""
    if not isinstance(status, (int, np.integer)):
        raise TypeError(f"it returned {status!r}, expected Status bits")
    return int(status)


def _words(cause: BaseException) -> str:
    """Of an error, whatever a driver has put into it: at most `_LONGEST` characters that can be sent on."""
    try:
        text = f"{type(cause).__name__}: {cause}"
    except Exception:  # noqa: BLE001 - its text is a driver's too
        text = type(cause).__name__
    return text.encode("utf-8", "replace").decode()[:_LONGEST]


def _measured(header: NDArray[np.void], what: str, took_ns: int) -> None:
    """How long a call took, smoothed, and the longest."""
    smoothed, longest = header[f"{what}_ns"], header[f"{what}_max_ns"]
    smoothed[0] = (int(smoothed[0]) * 63 + took_ns) // 64
    if took_ns > longest[0]:
        longest[0] = took_ns
