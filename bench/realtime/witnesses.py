"""What is watched beside a measurement: a normal viewer's gaps between frames, and the memory of a server."""

import contextlib
import threading
import time
from pathlib import Path

from bench.realtime.rig_load import Viewer

_EVERY_S = 0.5


class Gaps:
    """A normal viewer, in a thread: the gaps between its frames [s]."""

    def __init__(self, port: int, rig: str) -> None:
        self._viewer = Viewer(port, rig)
        self._viewer.link.setblocking(True)
        self.found: list[float] = []
        self.ended = False  # the server has let go of it
        threading.Thread(target=self._read, daemon=True).start()

    def _read(self) -> None:
        last, frames = time.monotonic(), self._viewer.frames
        with contextlib.suppress(OSError):
            while self._viewer.read():
                if self._viewer.frames == frames:
                    continue  # a part of one
                frames, now = self._viewer.frames, time.monotonic()
                self.found.append(now - last)
                last = now
        self.ended = True


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
