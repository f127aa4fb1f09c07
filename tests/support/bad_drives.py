"""Drives that misbehave, in a package as a third party's would be: found by its entry points.

`with_bad_drives` puts it on the path of the processes that are started; each drive is the simulated table, and is bad
while the file exists that its option `trigger` names (none: always).
"""

import ctypes
import os
import threading
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from fullpose._typing import Array
from fullpose.rig import Rig
from fullpose_server.drives.simulated import SimulatedDrive, SimulatedOptions
from tests.support.repository import ROOT

ENTRY_POINTS = "[fullpose.drives]\nbad = tests.support.bad_drives:make\n"


def _hang() -> None:
    """For good, the interpreter's lock let go of."""
    threading.Event().wait()


def _hang_alone() -> None:
    """For good, and no other thread of the process runs either."""
    ctypes.PyDLL(None).sleep(3600)


def _raise() -> None:
    raise OSError(5, "the card has gone")


def _pause() -> None:
    threading.Event().wait(0.4)


def _exhaust() -> None:
    raise MemoryError


FAULTS: dict[str, Callable[[], None]] = {
    "hangs": _hang,
    "hangs_alone": _hang_alone,
    "raises": _raise,
    "pauses": _pause,
    "exhausts": _exhaust,
}


class BadDrive(SimulatedDrive):
    """The `call` has the fault; `brakes` is a file in which its own brake is told."""

    name = "bad"

    def __init__(self, rig: Rig, rate_hz: float, fault: str, call: str, trigger: str, brakes: str) -> None:
        super().__init__(rig, rate_hz, SimulatedOptions(watchdog_s=0.5))
        self._fault = FAULTS[fault]
        self._call = call
        self._trigger = Path(trigger)
        self._brakes = Path(brakes)

    def connect(self, now: float) -> None:
        self._perhaps("connect")
        super().connect(now)

    def read(self, now: float, position: Array, rate: Array) -> int:
        self._perhaps("read")
        return super().read(now, position, rate)

    def write(self, position: Array, rate: Array, acceleration: Array, epoch: int, sequence: int) -> None:
        self._perhaps("write")
        super().write(position, rate, acceleration, epoch, sequence)

    def emergency_brake(self) -> None:
        self._brakes.write_text("used")
        super().emergency_brake()

    def _perhaps(self, call: str) -> None:
        if call == self._call and self._trigger.exists():
            self._fault()


def make(rig: Rig, rate_hz: float, options: dict[str, Any]) -> BadDrive:
    return BadDrive(rig, rate_hz, **options)


def with_bad_drives(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Processes started from here on find the drive `bad`."""
    info = folder / "site" / "bad_drives-1.0.dist-info"
    info.mkdir(parents=True)
    (info / "METADATA").write_text("Metadata-Version: 2.1\nName: bad-drives\nVersion: 1.0\n")
    (info / "entry_points.txt").write_text(ENTRY_POINTS)
    paths = [str(folder / "site"), str(ROOT), *filter(None, [os.environ.get("PYTHONPATH")])]
    monkeypatch.setenv("PYTHONPATH", os.pathsep.join(paths))
