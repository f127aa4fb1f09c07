"""The recorder, as a child of the rig process: started, waited for, started anew where it has ended."""

import contextlib
import os
import subprocess
import sys
from pathlib import Path

from fullpose_server.runtime.contract.shared_memory import Shared
from fullpose_server.runtime.loop.clock import Clock, seconds

_RECORDER = (sys.executable, "-m", "fullpose_server.runtime.recording.recorder")
_BEGINS_S = 10.0


class WaitingRecorder:
    """A recorder that has begun, and waits to be told what to record."""

    def __init__(self) -> None:
        self._process = subprocess.Popen([*_RECORDER, "--parent", str(os.getpid())], stdin=subprocess.PIPE)

    def begin(self, memory: Path, runs: Path) -> "subprocess.Popen[bytes]":
        """Tell it; it is a rig's from here on. One that has ended meanwhile is one that ended: it is started anew."""
        orders = self._process.stdin
        if orders is not None:
            with contextlib.suppress(BrokenPipeError), orders:
                orders.write(f"{memory}\n{runs}\n".encode())
        return self._process


class RecorderChild:
    """The recorder of one rig; the one that was `waiting`, where there is one."""

    def __init__(self, memory: Path, runs: Path, waiting: WaitingRecorder | None) -> None:
        self._memory, self._runs = memory, runs
        self._process = _started(memory, runs) if waiting is None else waiting.begin(memory, runs)

    @property
    def ended(self) -> bool:
        """Whether it runs no more."""
        return self._process.poll() is not None

    def revive(self) -> int | None:
        """Start it anew where it has ended: its process's number then, or None."""
        if not self.ended:
            return None
        self._process = _started(self._memory, self._runs)
        return self._process.pid

    def wait_for(self, shared: Shared, ticks: Clock) -> None:
        """Wait for its first sign of life; without one the session will refuse to arm, and say why."""
        deadline = seconds(ticks) + _BEGINS_S
        while seconds(ticks) < deadline and not self.ended:
            if int(shared.header["recorder_beat_ns"][0]):
                return
            ticks.sleep(0.01)


def _started(memory: Path, runs: Path) -> "subprocess.Popen[bytes]":
    command = [*_RECORDER, "--parent", str(os.getpid()), "--memory", str(memory), "--runs", str(runs)]
    return subprocess.Popen(command, stdin=subprocess.DEVNULL)
