"""Which rig processes run, told to whoever must know at once: the stop gate."""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path


@dataclass(frozen=True)
class RunningProcess:
    """The newest process of a rig."""

    rig: str
    pid: int
    memory: Path


class RunningProcesses:
    """By rig. `came` and `left` belong to the event loop's thread, as the callbacks do."""

    def __init__(self) -> None:
        self._running: dict[str, RunningProcess] = {}
        self._watching: list[Callable[[str, RunningProcess | None], None]] = []

    def came(self, process: RunningProcess) -> None:
        """A process runs for its rig, in place of an earlier one."""
        self._running[process.rig] = process
        for tell in self._watching:
            tell(process.rig, process)

    def left(self, rig: str) -> None:
        """The server has let go of the rig."""
        if self._running.pop(rig, None) is not None:
            for tell in self._watching:
                tell(rig, None)

    def all(self) -> list[RunningProcess]:
        """Those that run now."""
        return list(self._running.values())

    def watch(self, tell: Callable[[str, RunningProcess | None], None]) -> None:
        """Call `tell(rig, process)` at every change; None: the server has let go of it."""
        self._watching.append(tell)
