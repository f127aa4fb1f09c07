"""The watch of the drive's calls: it counts looks, takes the loop's turn once, and gives it back."""

import logging
import threading
from pathlib import Path

import numpy as np
import pytest

from fullpose._typing import Array
from fullpose.rig import builtin_rigs
from fullpose_server.drives.base import DriveError, Status
from fullpose_server.drives.simulated import SimulatedDrive, SimulatedOptions
from fullpose_server.runtime.contract.drive_call import DriveCall, Pending
from fullpose_server.runtime.contract.shared_memory import Shared
from fullpose_server.runtime.loop.clock import MadeUpClock
from fullpose_server.runtime.loop.drive_watch import DriveWatch
from fullpose_server.runtime.loop.watched_drive import WatchedDrive
from tests.support.waiting import until

PATIENCE_S = 60.0


class Stuck(SimulatedDrive):
    """Its read waits to be let go; its brakes are noted, with the thread that they came from."""

    def __init__(self) -> None:
        super().__init__(builtin_rigs()["vertical-4"], 1000.0, SimulatedOptions())
        self.inside, self.let_go = threading.Event(), threading.Event()
        self.braked: list[tuple[str, str]] = []

    def read(self, now: float, position: Array, rate: Array) -> int:
        self.inside.set()
        assert self.let_go.wait(PATIENCE_S)
        return super().read(now, position, rate)

    def brake(self) -> None:
        self.braked.append(("brake", threading.current_thread().name))
        super().brake()

    def emergency_brake(self) -> None:
        self.braked.append(("emergency_brake", threading.current_thread().name))


class Notes:
    """What the watch had done in the loop's place."""

    def __init__(self, drive: WatchedDrive) -> None:
        self.drive = drive
        self.said: list[str] = []
        self.call: Pending | None = None

    def hangs(self, call: Pending, brake: str) -> None:
        self.call = call
        self.said.append(brake)
        self.drive.brake()  # as a fault does: not to reach a drive that hangs, but once it is back

    def tend(self) -> None:
        self.said.append("tended")

    def last(self, call: Pending) -> None:  # noqa: ARG002
        self.said.append("last")


class Watched:
    """A drive in whose read a thread is, as a loop would be."""

    def __init__(self, tmp_path: Path) -> None:
        self.clock = MadeUpClock()
        self.table = Stuck()
        self.shared = Shared(tmp_path / "memory", create=True)
        self.drive = WatchedDrive(self.table, self.shared.header, self.clock)
        self.drive.connect(0.0)
        self.notes = Notes(self.drive)
        self.ended: list[str] = []
        self.watch = DriveWatch(self.drive, self.notes, self.clock, lambda: None, lambda: self.ended.append("end"))
        self.status = -1
        self.loop = threading.Thread(target=self._read, name="loop", daemon=True)

    def _read(self) -> None:
        self.status = self.drive.read(0.001, np.zeros(4), np.zeros(4))

    def hang(self) -> None:
        self.loop.start()
        assert self.table.inside.wait(PATIENCE_S)

    def look(self, times: int) -> None:
        for _ in range(times):
            self.watch.look()


@pytest.fixture
def watched(tmp_path: Path) -> Watched:
    return Watched(tmp_path)


def test_a_call_that_stays_is_named_and_the_drives_own_brake_used(watched: Watched) -> None:
    watched.hang()
    watched.look(6)
    assert watched.notes.said == []
    watched.look(20)
    assert watched.notes.call is not None
    assert watched.notes.call.call is DriveCall.READ
    assert watched.notes.said[0] == "its emergency brake was used"
    assert watched.table.braked == [("emergency_brake", "emergency brake")]
    watched.table.let_go.set()
    until(lambda: watched.notes.drive._returned)
    watched.look(1)
    watched.loop.join(PATIENCE_S)
    assert watched.status == 0  # the loop has its answer, and what was owed to the drive was done by the loop
    assert watched.table.braked[1:] == [("brake", "loop")]
    assert watched.ended == []


def test_one_that_never_returns_ends_the_process(watched: Watched) -> None:
    watched.hang()
    watched.look(200)
    assert watched.notes.said[-1] == "last"
    assert watched.ended
    with pytest.raises(DriveError, match="does not return from an earlier call"):
        watched.drive.enable()
    watched.table.let_go.set()


def test_calls_that_return_are_never_one_that_hangs(watched: Watched) -> None:
    watched.table.let_go.set()
    for _ in range(100):
        watched.drive.read(0.0, np.zeros(4), np.zeros(4))
        watched.watch.look()
    assert watched.notes.said == []


def test_a_brake_that_hangs_too_is_said(watched: Watched, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(watched.table, "emergency_brake", lambda: watched.table.let_go.wait(PATIENCE_S))
    watched.hang()
    watched.look(20)
    assert watched.notes.said[0] == "its emergency brake has not returned either"
    watched.table.let_go.set()


def test_what_a_call_raises_is_a_fault_with_its_time(watched: Watched, monkeypatch: pytest.MonkeyPatch) -> None:
    def broken(*_: object) -> int:
        watched.clock.now += 3_000_000
        raise OSError(5, "gone")

    monkeypatch.setattr(watched.table, "read", broken)
    position, rate = np.zeros(4), np.zeros(4)
    assert watched.drive.read(0.0, position, rate) == Status.FAULT
    assert np.isnan(position).all()
    failure = watched.drive.failure()
    assert failure is not None
    assert (failure.call, failure.took_ns) == (DriveCall.READ, 3_000_000)
    assert failure.cause == "drive simulated: read raised OSError: [Errno 5] gone (after 3 ms)"
    assert watched.drive.failure() is None
    monkeypatch.setattr(watched.table, "connect", broken)
    with pytest.raises(DriveError, match=r"connect raised OSError: \[Errno 5\] gone \(after 3 ms\)"):
        watched.drive.connect(0.0)


@pytest.mark.parametrize("status", [None, "ok", 1.0, [1]])
def test_a_read_that_does_not_return_bits_is_a_fault_too(
    watched: Watched, monkeypatch: pytest.MonkeyPatch, status: object
) -> None:
    monkeypatch.setattr(watched.table, "read", lambda *_: status)
    position = np.zeros(4)
    assert watched.drive.read(0.0, position, np.zeros(4)) == Status.FAULT
    assert np.isnan(position).all()
    failure = watched.drive.failure()
    assert failure is not None
    assert f"read raised TypeError: it returned {status!r}, expected Status bits" in failure.cause


class UntoldError(Exception):
    def __str__(self) -> str:
        raise ValueError


@pytest.mark.parametrize(
    ("cause", "told"),
    [
        (SystemExit(3), "SystemExit: 3"),
        (KeyboardInterrupt(), "KeyboardInterrupt: "),
        (UntoldError(), "UntoldError"),
        (OSError("\udcff"), "OSError: ?"),
        (OSError("x" * 100_000), f"OSError: {'x' * 291}"),
    ],
)
@pytest.mark.parametrize("call", ["read", "write"])
def test_whatever_a_call_raises_ends_no_loop_and_can_be_told(
    watched: Watched, monkeypatch: pytest.MonkeyPatch, call: str, cause: BaseException, told: str
) -> None:
    def raises(*_: object) -> int:
        raise cause

    monkeypatch.setattr(watched.table, call, raises)
    # With halves of characters in its log a test's report cannot be sent by pytest's workers.
    monkeypatch.setattr(logging.getLogger("fullpose.rig"), "disabled", True)
    numbers = np.zeros(4), np.zeros(4)
    if call == "read":
        assert watched.drive.read(0.0, *numbers) == Status.FAULT
    else:
        watched.drive.write(*numbers, np.zeros(4), 1, 1)
    failure = watched.drive.failure()
    assert failure is not None
    assert f"{call} raised {told} (after" in failure.cause


def test_what_a_drive_does_to_its_arrays_does_nothing_to_the_loops(
    watched: Watched, monkeypatch: pytest.MonkeyPatch
) -> None:
    kept: list[Array] = []

    def read(_now: float, position: Array, rate: Array) -> int:
        position[:], rate[:] = 1.0, 2.0
        kept.extend((position, rate))
        return int(Status.ENABLED)

    def write(*arrays: Array | int) -> None:
        for demand in arrays[:3]:
            assert isinstance(demand, np.ndarray)
            demand *= 57.0  # degrees, say: in place

    monkeypatch.setattr(watched.table, "read", read)
    monkeypatch.setattr(watched.table, "write", write)
    position, rate, acceleration = np.zeros(4), np.zeros(4), np.full(4, 3.0)
    assert watched.drive.read(0.0, position, rate) == Status.ENABLED
    for each in kept:
        each[:] = 99.0
    watched.drive.write(position, rate, acceleration, 1, 1)
    assert watched.drive.failure() is None
    assert [each.tolist() for each in (position, rate, acceleration)] == [[1.0] * 4, [2.0] * 4, [3.0] * 4]


def reshaped(_now: float, position: Array, _rate: Array) -> int:
    position.resize((3,), refcheck=False)
    return 0


def locked(_now: float, position: Array, _rate: Array) -> int:
    position.setflags(write=False)
    return 0


@pytest.mark.parametrize("read", [reshaped, locked])
def test_one_that_spoils_its_arrays_is_a_fault_and_is_given_others(
    watched: Watched, monkeypatch: pytest.MonkeyPatch, read: object
) -> None:
    monkeypatch.setattr(watched.table, "read", read)
    position, rate = np.zeros(4), np.zeros(4)
    statuses = [watched.drive.read(0.0, position, rate) for _ in range(2)]
    assert Status.FAULT in statuses
    assert position.shape == (4,)
    assert watched.drive.failure() is not None
    monkeypatch.setattr(watched.table, "read", lambda *_: int(Status.ENABLED))
    watched.drive.read(0.0, position, rate)
    assert watched.drive.read(0.0, position, rate) == Status.ENABLED
