"""Watches the loop's calls of its drive, on a thread of the rig process: one that does not return is named, the
drive's own brake used, and whoever asks for a stop answered; one that never returns ends the process.

It counts looks, not time: a process that was put aside itself has looked no oftener than its drive was called. A drive
that keeps the interpreter's lock stops this thread as well: then the supervisor in the server, or the recorder, ends
the process, by the mark that the call has left in the shared memory (`contract.drive_call`).
"""

import logging
import os
import threading
from collections.abc import Callable
from typing import Protocol

from fullpose_server.runtime.contract.drive_call import DriveCall, Pending
from fullpose_server.runtime.loop.clock import Clock
from fullpose_server.runtime.loop.watched_drive import WatchedDrive

LOOK_S = 0.01
_PATIENCE = {DriveCall.CONNECT: 1500, DriveCall.CLOSE: 100}  # [looks] of the calls that are `drive_call.PATIENT`
_ELSE = 8
_GIVES_UP = 100  # looks after it was named
_BRAKE_S = 0.05
log = logging.getLogger("fullpose.rig")


class Care(Protocol):
    """Who acts in the loop's place while it hangs."""

    def hangs(self, call: Pending, brake: str) -> None:
        """The loop hangs in this call; `brake` says what became of the drive's own brake."""
        ...

    def tend(self) -> None:
        """It still does: answer who asks for a stop."""
        ...

    def last(self, call: Pending) -> None:
        """It will not return: the last words."""
        ...


class DriveWatch:
    """Of one loop. `stacks` writes where every thread is to the log, `end` ends the process."""

    def __init__(
        self, drive: WatchedDrive, care: Care, clock: Clock, stacks: Callable[[], None], end: Callable[[], None]
    ) -> None:
        self._drive = drive
        self._care = care
        self._clock = clock
        self._stacks = stacks
        self._end = end
        self._number = 0
        self._looks = 0
        self._call: Pending | None = None  # the one that hangs

    def start(self, priority: int | None) -> None:
        """Look from now on, scheduled as the loop is: at its priority where it is real-time."""
        threading.Thread(target=self._run, args=(priority,), name="drive watch", daemon=True).start()

    def _run(self, priority: int | None) -> None:
        if priority is not None:
            try:
                os.sched_setscheduler(0, os.SCHED_FIFO | os.SCHED_RESET_ON_FORK, os.sched_param(priority))
            except OSError as refusal:
                log.warning("the watch of the drive is not real-time: %s", refusal.strerror)
        while True:
            self._clock.sleep(LOOK_S)
            self.look()

    def look(self) -> None:
        """Look once; to be done every `LOOK_S`."""
        if self._call is not None:
            self._attend(self._call)
            return
        number = self._drive.in_call()
        if number == 0 or number != self._number:
            self._number, self._looks = number, 0
            return
        self._looks += 1
        if self._looks < _ELSE:
            return
        self._call = self._named(number)

    def _named(self, number: int) -> Pending | None:
        call = self._drive.call
        if self._looks < _PATIENCE.get(call, _ELSE):
            return None
        taken = self._drive.take(number)
        if taken is not None:
            self._looks = 0
            self._care.hangs(taken, self._braked())
            self._stacks()
        return taken

    def _attend(self, call: Pending) -> None:
        if self._drive.give_back():
            self._call = None
            self._number = self._looks = 0
            return
        self._care.tend()
        self._looks += 1
        if self._looks > _GIVES_UP:
            self._care.last(call)
            self._end()

    def _braked(self) -> str:
        """Use the drive's own brake: what became of it. On a thread again: it may hang as the call does."""
        said = ["its emergency brake has not returned either"]

        def brake() -> None:
            try:
                self._drive.emergency_brake()
                said[0] = "its emergency brake was used"
            except Exception as cause:
                log.exception("drive %s: emergency_brake", self._drive.name)
                said[0] = f"its emergency brake raised {type(cause).__name__}: {cause}"

        thread = threading.Thread(target=brake, name="emergency brake", daemon=True)
        thread.start()
        thread.join(_BRAKE_S)
        return said[0]
