"""Time for the loop: absolute deadlines on the monotonic clock, real-time scheduling, locked memory.

Lateness is how long after its deadline a tick begins. A tick that begins a whole period late has missed its deadline;
the deadlines it slept through are left out, not caught up: a burst of commands would be faster than the rig's limits.
"""

import ctypes
import ctypes.util
import gc
import os
import time
from typing import Protocol

from fullpose_server.runtime.loop.scheduling_rights import own_rights, why_refused

_MCL_CURRENT, _MCL_FUTURE = 1, 2


def go_realtime(priority: int | None, cpu: int | None) -> str:
    """Ask for SCHED_FIFO and locked memory; says in words what was granted and, if not, how to get it."""
    if cpu is not None:
        os.sched_setaffinity(0, {cpu})
    if priority is None:
        return "off: not asked for"
    try:
        # Children (there should be none) must not inherit it.
        os.sched_setscheduler(0, os.SCHED_FIFO | os.SCHED_RESET_ON_FORK, os.sched_param(priority))
    except (PermissionError, OSError) as refusal:
        return f"off: SCHED_FIFO refused ({refusal.strerror}): {why_refused(own_rights(), priority)}"
    libc = ctypes.CDLL(ctypes.util.find_library("c"), use_errno=True)
    if libc.mlockall(_MCL_CURRENT | _MCL_FUTURE) != 0:
        why = os.strerror(ctypes.get_errno())
        return f"on: SCHED_FIFO {priority}; memory not locked ({why}): give CAP_IPC_LOCK, or ulimit -l unlimited"
    return f"on: SCHED_FIFO {priority}, memory locked"


def realtime_granted(priority: int | None) -> bool:
    """Whether SCHED_FIFO at `priority` would be granted: asked for, and given back at once."""
    if priority is None:
        return False
    before, parameters = os.sched_getscheduler(0), os.sched_getparam(0)
    try:
        os.sched_setscheduler(0, os.SCHED_FIFO, os.sched_param(priority))
    except OSError:
        return False
    os.sched_setscheduler(0, before, parameters)
    return True


def still_collector() -> None:
    """Keep the garbage collector out of the loop; the loop collects by itself while the rig is at rest."""
    gc.collect()
    gc.freeze()
    gc.disable()


class Clock(Protocol):
    """The time as the rig process sees it; a test's is made up."""

    def monotonic_ns(self) -> int:
        """Time that only grows [ns]."""
        ...

    def wall_ns(self) -> int:
        """Time since the Unix epoch [ns], as the machine's clock was set last."""
        ...

    def steady_ns(self) -> int:
        """Time since the Unix epoch [ns], as it was when the process began, and what has passed: nobody sets it."""
        ...

    def sleep(self, seconds: float) -> None:
        """Wait for so long."""
        ...


class SystemClock:
    """This machine's."""

    def __init__(self) -> None:
        self._began_ns = time.time_ns() - time.monotonic_ns()

    def monotonic_ns(self) -> int:
        """Time since some moment before the process began [ns]."""
        return time.monotonic_ns()

    def wall_ns(self) -> int:
        """Time since the Unix epoch [ns]."""
        return time.time_ns()

    def steady_ns(self) -> int:
        """Time since the Unix epoch [ns], by the monotonic clock from the process's beginning on."""
        return self._began_ns + time.monotonic_ns()

    def sleep(self, seconds: float) -> None:
        """Wait for so long."""
        time.sleep(seconds)


class MadeUpClock:
    """Moved by its owner alone, `now` in [ns]: a minute of the loop takes a second, in tests and benches."""

    def __init__(self) -> None:
        self.now = 1_000_000_000_000
        self.set_by = 0  # [ns] by how much somebody has set the wall clock

    def monotonic_ns(self) -> int:
        """Made up [ns]."""
        return self.now

    def wall_ns(self) -> int:
        """Made up [ns]."""
        return self.steady_ns() + self.set_by

    def steady_ns(self) -> int:
        """Made up [ns]."""
        return 1_700_000_000_000_000_000 + self.now

    def sleep(self, seconds: float) -> None:
        """Moves on by exactly so long."""
        self.now += round(seconds * 1e9)


def seconds(clock: Clock) -> float:
    """Monotonic time [s]."""
    return clock.monotonic_ns() / 1e9


class Deadlines:
    """Deadlines every `period_ns`, from the first `wait` on."""

    def __init__(self, period_ns: int, clock: Clock) -> None:
        self.period_ns = period_ns
        self._clock = clock
        self._next = 0

    def wait(self) -> tuple[int, int, int]:
        """Sleep until the next deadline: (now, lateness, deadlines missed), [ns] and a count."""
        now = self._clock.monotonic_ns()
        if self._next == 0:
            self._next = now + self.period_ns
        ahead = self._next - now
        if ahead > 0:
            self._clock.sleep(ahead / 1e9)
            now = self._clock.monotonic_ns()
        lateness = now - self._next
        missed = lateness // self.period_ns if lateness > 0 else 0
        self._next += self.period_ns * (missed + 1)
        return now, max(0, lateness), missed

    def restart(self) -> None:
        """Begin anew at the next `wait`: after work at rest that was allowed to take long."""
        self._next = 0
