"""What is watched beside a measurement: a normal viewer's gaps between frames, and the memory of a server.

`python -m bench.realtime.witnesses --port P --rig R` is the viewer, a process of its own: what is measured is the
server. As a thread of the bench it waited for that one's interpreter, which a busy machine puts aside as it likes.
"""

import argparse
import contextlib
import struct
import subprocess
import sys
import threading
import time
from pathlib import Path

from bench.realtime.rig_load import Viewer
from fullpose_server.gate.system import SERVER, before_others

_EVERY_S = 0.5
_GAP = struct.Struct("d")


class Gaps:
    """A normal viewer: the gaps between its frames [s], as they come."""

    def __init__(self, port: int, rig: str) -> None:
        command = [sys.executable, "-m", "bench.realtime.witnesses", "--port", str(port), "--rig", rig]
        self._viewer = subprocess.Popen(command, stdout=subprocess.PIPE)
        self.found: list[float] = []
        self.ended = False  # the server has let go of it
        self._reading = threading.Thread(target=self._read, daemon=True)
        self._reading.start()

    def close(self) -> None:
        """Watch no more."""
        self._viewer.terminate()
        self._viewer.wait()
        self._reading.join()

    def _read(self) -> None:
        assert self._viewer.stdout is not None
        with self._viewer.stdout as told:
            while len(data := told.read(_GAP.size)) == _GAP.size:
                self.found += _GAP.unpack(data)
        self.ended = True


def _watch(port: int, rig: str) -> None:
    viewer = Viewer(port, rig)
    viewer.link.setblocking(True)
    before_others(SERVER)
    last, frames = time.monotonic(), viewer.frames
    with contextlib.suppress(OSError):
        while viewer.read():
            if viewer.frames == frames:
                continue  # a part of one
            frames, now = viewer.frames, time.monotonic()
            sys.stdout.buffer.write(_GAP.pack(now - last))
            sys.stdout.buffer.flush()
            last = now


class Memory:
    """Of a server, and of it with what it has started but for rig processes, the most that was seen [MB]."""

    def __init__(self, pid: int) -> None:
        self._pid = pid
        self.with_workers_mb = 0.0
        self._over = threading.Event()
        self._watching = threading.Thread(target=self._watch, daemon=True)
        self._watching.start()

    @property
    def server_mb(self) -> float:
        """The most that the server's own process has held, by the kernel."""
        status = Path(f"/proc/{self._pid}/status").read_text("utf-8")
        return int(status.split("VmHWM:")[1].split()[0]) / 1024.0

    def close(self) -> None:
        """Watch no more."""
        self._over.set()
        self._watching.join()

    def _watch(self) -> None:
        while not self._over.wait(_EVERY_S):
            held = sum(_resident_mb(pid) for pid in [self._pid, *_children(self._pid)])
            self.with_workers_mb = max(self.with_workers_mb, held)


def _children(pid: int) -> list[int]:
    found: list[int] = []
    for task in Path(f"/proc/{pid}/task").glob("*/children"):
        with contextlib.suppress(OSError):
            found += [int(child) for child in task.read_text("utf-8").split()]
    return [child for child in found if "runtime.loop.process" not in _command(child)]


def _command(pid: int) -> str:
    try:
        return Path(f"/proc/{pid}/cmdline").read_text("utf-8", "replace")
    except OSError:
        return ""


def _resident_mb(pid: int) -> float:
    try:
        lines = Path(f"/proc/{pid}/status").read_text("utf-8").splitlines()
    except OSError:
        return 0.0
    return sum(int(line.split()[1]) for line in lines if line.startswith("VmRSS:")) / 1024.0


if __name__ == "__main__":
    _arguments = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    _arguments.add_argument("--port", type=int, required=True)
    _arguments.add_argument("--rig", required=True)
    _given = _arguments.parse_args()
    _watch(_given.port, _given.rig)
