"""A gate whose event loop no longer runs is ended at once by who started it: another stands behind it.

Told apart by what the system says of its thread: one that waits for something else than its loop, or computes without
end, hangs; one that would run and gets no processor, or waits for a disk, is starved, and so would its successor be;
one that is suspended is woken (`waker`).
"""

import contextlib
import logging
import os
import select
import signal
import threading
from dataclasses import dataclass
from pathlib import Path

from fullpose_server.gate.beat import Beat
from fullpose_server.gate.system import GATE, before_others

LOOK_MS = 50
BLOCKED = 5  # looks in a row at which it slept, and its loop had not run between them
SPINS_S = 0.4  # of the processor since its loop ran last; no single step of a gate takes a tenth of that
_TICKS_S = 1.0 / os.sysconf("SC_CLK_TCK")
log = logging.getLogger(__name__)


@dataclass(frozen=True)
class Thread:
    """What the system says of the thread that the event loop is of (proc(5))."""

    state: str  # R, S, D, T...
    used_s: float  # of the processor

    @classmethod
    def of(cls, pid: int) -> "Thread":
        """Of the main thread of a process. Raises `OSError` where there is none."""
        fields = Path(f"/proc/{pid}/task/{pid}/stat").read_text("ascii", "replace").rsplit(")", 1)[1].split()
        return cls(fields[0], (int(fields[11]) + int(fields[12])) * _TICKS_S)


class Looks:
    """One look after another at one gate. They are counted, not timed: who was put aside itself looks less often."""

    def __init__(self) -> None:
        self._beat_ns = 0
        self._asleep = 0
        self._used_s: float | None = None

    def hangs(self, beat_ns: int, thread: Thread) -> str | None:
        """Why, in words, if it does; one that has not begun yet does not."""
        if beat_ns != self._beat_ns or self._used_s is None:
            self._beat_ns, self._asleep, self._used_s = beat_ns, 0, thread.used_s
        elif beat_ns and thread.state == "S":
            self._asleep += 1
        if self._asleep >= BLOCKED:
            return "it waits for something"
        used_s = thread.used_s - self._used_s
        return f"it has computed for {used_s:.2g} s" if beat_ns and used_s >= SPINS_S else None


def end_if_it_hangs(pid: int, beat: Beat) -> threading.Thread:
    """Watch the gate `pid`, a child, for as long as it lives; killed, it is for its starter to reap and to replace.

    In a thread of its own: the server's event loop may be what somebody keeps busy.
    """
    watching = threading.Thread(target=_watch, args=(os.pidfd_open(pid), pid, beat), name="gate watch", daemon=True)
    watching.start()
    return watching


def _watch(pidfd: int, pid: int, beat: Beat) -> None:
    before_others(GATE)
    looks, ended = Looks(), select.poll()
    ended.register(pidfd, select.POLLIN)
    try:
        with contextlib.suppress(OSError, IndexError, ProcessLookupError):  # it has ended meanwhile
            while not ended.poll(LOOK_MS):
                why = looks.hangs(beat.last_ns, Thread.of(pid))
                if why is not None:
                    signal.pidfd_send_signal(pidfd, signal.SIGKILL)
                    log.error("the event loop of the stop gate, process %d, hangs (%s): it is ended", pid, why)
                    return
    finally:
        os.close(pidfd)
