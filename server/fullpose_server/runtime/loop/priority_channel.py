"""The priority channel: E-stop and stop as times in the shared memory, that wait behind no other command."""

import numpy as np
from numpy.typing import NDArray

from fullpose_server.runtime.contract.memory_order import acquire, release
from fullpose_server.runtime.loop.clock import Clock
from fullpose_server.session.states import Command

_CHANNELS = (("estop", Command.ESTOP), ("stop", Command.STOP))


class PriorityChannel:
    """Reads what the server asks, answers when the first braking command is written. `header` is the shared one."""

    def __init__(self, header: NDArray[np.void], clock: Clock) -> None:
        self._header = header
        self._clock = clock
        self._obeyed: list[tuple[str, int]] = []
        self._unwritten: list[str] = []

    def asked(self) -> list[tuple[Command, str]]:
        """What was asked since the last tick, and by whom."""
        found = []
        for channel, command in _CHANNELS:
            asked = int(self._header[f"{channel}_request_ns"][0])
            if asked != int(self._header[f"{channel}_done_ns"][0]):
                acquire()
                found.append((command, bytes(self._header[f"{channel}_who"][0]).decode("utf-8", "replace")))
                self._obeyed.append((channel, asked))
                self._unwritten.append(channel)
        return found

    def written(self) -> None:
        """A command was written to the drive."""
        if self._unwritten:
            for channel in self._unwritten:
                self._header[f"{channel}_wrote_ns"] = self._clock.monotonic_ns()
            self._unwritten.clear()

    @property
    def waiting(self) -> bool:
        """Whether somebody waits to be told that it is done."""
        return bool(self._obeyed)

    def done(self) -> None:
        """Tell them; what it led to is published before."""
        release()
        for channel, asked in self._obeyed:
            self._header[f"{channel}_done_ns"] = asked
        self._obeyed.clear()
