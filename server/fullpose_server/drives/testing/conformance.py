"""What every drive must do, as tests that any driver can be run through.

In a driver's own tests: `class TestMine(DriveConformance)` with a `make_drive` that returns a fresh, unconnected drive
and, where it is a real link, `tick` to let time pass for it. pytest collects the rest. Whatever else a test is about,
every status that it reads must agree with what was measured (see `read`).
"""

import math
import statistics
import threading
import time

import numpy as np

from fullpose._typing import Array
from fullpose.rig import Rig, builtin_rigs
from fullpose_server.drives.base import Drive, DriveError, Status

_SHARE = 0.25  # of a period, for each of read and write
_RETURNS_S = 10.0


class DriveConformance:
    """Tests of the interface's promises; `rate_hz` and `rig` may be overridden."""

    rate_hz = 1000.0
    rig: Rig = builtin_rigs()["vertical-4"]

    def make_drive(self) -> Drive:
        """A fresh, unconnected drive of `rig` at `rate_hz`."""
        raise NotImplementedError

    def tick(self, now: float) -> float:
        """One period passes for the drive; returns the new time. A real link sleeps here."""
        return now + 1.0 / self.rate_hz

    # --- helpers ---

    def read(self, drive: Drive, now: float, position: Array, rate: Array) -> int:
        """What `drive.read` says, which must be so: the loop disconnects, or brakes, by it alone."""
        status = drive.read(now, position, rate)
        lost = bool(np.isnan(position).any())
        assert not status & Status.LINK_LOST, "read reports LINK_LOST, and the link is up since connect has returned"
        assert bool(status & Status.ENCODER) is lost, (
            "ENCODER goes with nan where the position is not known, and nan with it"
        )
        assert np.isfinite(rate).all() or lost, "a rate is not finite"
        return status

    def _ready(self) -> tuple[Drive, float, Array, Array]:
        drive = self.make_drive()
        now = time.monotonic()
        drive.connect(now)
        position, rate = np.full(4, math.nan), np.full(4, math.nan)
        now = self.tick(now)
        self.read(drive, now, position, rate)
        return drive, now, position, rate

    def _hold(self, drive: Drive, now: float, at: Array, ticks: int, sequence: int) -> tuple[float, int, int]:
        position, rate = np.zeros(4), np.zeros(4)
        status = 0
        for _ in range(ticks):
            now = self.tick(now)
            status = self.read(drive, now, position, rate)
            sequence += 1
            drive.write(at, np.zeros(4), np.zeros(4), 1, sequence)
        return now, sequence, status

    def _enabled(self) -> tuple[Drive, float, Array, int]:
        """A drive, enabled and held for a while where it stood (4,) [rad]; the status then."""
        drive, now, position, _ = self._ready()
        at = position.copy()
        drive.enable()
        now, _, status = self._hold(drive, now, at, 50, 0)
        return drive, now, at, status

    def _until_taken(self, drive: Drive, now: float, ticks: int = 2000) -> tuple[float, int]:
        """Ticks without writes until the table has taken the last order; the status then."""
        position, rate = np.zeros(4), np.zeros(4)
        for _ in range(ticks):
            now = self.tick(now)
            status = self.read(drive, now, position, rate)
            if not status & (Status.UNCONFIRMED | Status.LINK_LOST):
                return now, status
        raise AssertionError(f"an order is not taken within {ticks} ticks")

    # --- the promises ---

    def test_it_has_a_name(self) -> None:
        """The name shows in health and alarms."""
        assert self.make_drive().name

    def test_it_does_not_enable_before_it_is_connected(self) -> None:
        """Enabling without a link is an error, not a wish."""
        try:
            self.make_drive().enable()
        except DriveError:
            return
        raise AssertionError("enable succeeded without connect")

    def test_it_measures_at_rest_when_connected(self) -> None:
        """Positions are finite, and the table stands."""
        drive, _, position, rate = self._ready()
        assert np.isfinite(position).all()
        assert np.abs(rate).max() < math.radians(1.0)
        drive.close()

    def test_read_and_write_do_not_block(self) -> None:
        """Half of the calls at least take less than a quarter of a period each: the loop has its own work to do in it.

        The median, because this machine may put us aside in any one of them.
        """
        drive, now, position, rate = self._ready()
        at = position.copy()
        drive.enable()
        took: dict[str, list[float]] = {"read": [], "write": []}
        for k in range(1, 201):
            now = self.tick(now)
            begun = time.perf_counter()
            self.read(drive, now, position, rate)
            between = time.perf_counter()
            drive.write(at, np.zeros(4), np.zeros(4), 1, k)
            took["read"].append(between - begun)
            took["write"].append(time.perf_counter() - between)
        for call, times in took.items():
            median_ms, most_ms = statistics.median(times) * 1e3, 1e3 * _SHARE / self.rate_hz
            assert median_ms < most_ms, f"{call} takes {median_ms:.3g} ms, of a period at most {most_ms:.3g} ms"
        drive.close()

    def test_enabling_does_not_move_it(self) -> None:
        """The table stays where it stands until it is told otherwise."""
        drive, now, before, status = self._enabled()
        after, rate = np.zeros(4), np.zeros(4)
        self.read(drive, self.tick(now), after, rate)
        assert status & Status.ENABLED
        assert np.abs(after - before).max() < math.radians(0.05)
        drive.close()

    def test_it_follows(self) -> None:
        """A smooth degree in half a second is followed to a twentieth of a degree."""
        drive, now, position, rate = self._ready()
        start = position.copy()
        drive.enable()
        n = round(0.5 * self.rate_hz)
        w = math.pi / (n / self.rate_hz)
        moving = np.array([1.0 if i in self.rig.geometry.frames else 0.0 for i in range(4)]) * math.radians(0.5)
        for k in range(1, n + round(0.1 * self.rate_hz)):
            now = self.tick(now)
            self.read(drive, now, position, rate)
            t = min(k, n) / self.rate_hz
            x = start + moving * (1.0 - math.cos(w * t))
            v = moving * w * math.sin(w * t)
            drive.write(x, v, moving * w * w * math.cos(w * t), 1, k)
        self.read(drive, self.tick(now), position, rate)
        assert np.abs(position - (start + 2.0 * moving)).max() < math.radians(0.05)
        drive.close()

    def test_old_writes_are_refused(self) -> None:
        """A write of an older epoch, or out of sequence, changes nothing and is reported."""
        drive, now, position, rate = self._ready()
        start = position.copy()
        drive.enable()
        far = start + math.radians(1.0)
        zero = np.zeros(4)
        now, sequence, _ = self._hold(drive, now, start, 3, 10)
        seen = 0
        for epoch, number in ((0, sequence + 1), (1, sequence), (1, 1)):
            drive.write(far, zero, zero, epoch, number)
            for _ in range(3):
                now = self.tick(now)
                seen |= self.read(drive, now, position, rate)
        assert seen & Status.STALE_WRITE
        assert np.abs(position - start).max() < math.radians(0.05)
        drive.close()

    def test_it_brakes_by_itself_when_writes_stop(self) -> None:
        """The watchdog: nobody writes, the table stands within a second, and says so."""
        drive, now, position, rate = self._ready()
        drive.enable()
        start = position.copy()
        speed = np.zeros(4)
        speed[3] = math.radians(5.0)
        for k in range(1, round(0.2 * self.rate_hz)):
            now = self.tick(now)
            self.read(drive, now, position, rate)
            drive.write(start + speed * k / self.rate_hz, speed, np.zeros(4), 1, k)
        status = 0
        for _ in range(round(1.0 * self.rate_hz)):
            now = self.tick(now)
            status |= self.read(drive, now, position, rate)
        assert status & Status.WATCHDOG
        assert np.abs(rate).max() < math.radians(0.1)
        drive.close()

    def test_it_brakes_when_told_whatever_is_written(self) -> None:
        """`brake` wins over writes."""
        drive, now, position, rate = self._ready()
        drive.enable()
        now, sequence, _ = self._hold(drive, now, position.copy(), 5, 0)
        drive.brake()
        far = position + math.radians(10.0)
        now, _, status = self._hold(drive, now, far, round(0.1 * self.rate_hz), sequence)
        self.read(drive, self.tick(now), position, rate)
        assert not status & Status.ENABLED
        assert np.abs(position - far).max() > math.radians(9.0)
        drive.close()

    def test_it_brakes_when_another_thread_has_to(self) -> None:
        """`emergency_brake` is what is left where the loop's own call does not return: it wins over writes too."""
        drive, now, position, rate = self._ready()
        drive.enable()
        now, sequence, _ = self._hold(drive, now, position.copy(), 50, 0)
        start = position.copy()
        other = threading.Thread(target=drive.emergency_brake, daemon=True)
        other.start()
        other.join(_RETURNS_S)
        assert not other.is_alive(), "emergency_brake does not return"
        now, sequence, _ = self._hold(drive, now, start + math.radians(10.0), 50, sequence)
        now, status = self._until_taken(drive, now)
        self.read(drive, self.tick(now), position, rate)
        assert not status & Status.ENABLED
        assert np.abs(position - start).max() < math.radians(1.0)
        drive.enable()  # and is left by it
        sequence = 0
        while not status & Status.ENABLED:
            assert sequence < 2000
            now, sequence, status = self._hold(drive, now, position.copy(), 1, sequence)
        drive.close()

    def test_it_does_not_follow_when_disabled(self) -> None:
        """`disable` wins over writes, and shows."""
        drive, now, position, rate = self._ready()
        drive.enable()
        start = position.copy()
        now, sequence, _ = self._hold(drive, now, start, 50, 0)
        drive.disable()
        now, sequence, _ = self._hold(drive, now, start + math.radians(10.0), 50, sequence)
        now, status = self._until_taken(drive, now)
        self.read(drive, self.tick(now), position, rate)
        assert not status & Status.ENABLED
        assert np.abs(position - start).max() < math.radians(1.0)
        drive.close()

    def test_enabling_again_begins_a_new_series(self) -> None:
        """After `brake` and after `disable` the sequence counts from one again, and nothing of before is refused."""
        drive, now, position, rate = self._ready()
        start = position.copy()
        moving = np.array([1.0 if i in self.rig.geometry.frames else 0.0 for i in range(4)]) * math.radians(0.5)
        drive.enable()
        now, _, _ = self._hold(drive, now, start, 50, 1000)
        for turn, end in enumerate((drive.brake, drive.disable), 1):
            end()
            now, _ = self._until_taken(drive, now)
            drive.enable()
            seen = 0
            n = round(0.2 * self.rate_hz)
            at = start + (turn - 1) * moving
            for k in range(1, n + round(0.2 * self.rate_hz)):
                now = self.tick(now)
                seen |= self.read(drive, now, position, rate)
                share = min(k, n) / n
                drive.write(at + share * share * (3.0 - 2.0 * share) * moving, np.zeros(4), np.zeros(4), 1, k)
            status = self.read(drive, self.tick(now), position, rate)
            assert status & Status.ENABLED
            assert not seen & Status.STALE_WRITE
            assert np.abs(position - (start + turn * moving)).max() < math.radians(0.05)
        drive.close()

    def test_enabling_again_forgets_the_watchdog(self) -> None:
        """What is read after `enable` is never the watchdog of before."""
        drive, now, start, _ = self._enabled()
        position, rate = np.zeros(4), np.zeros(4)
        status = 0
        for _ in range(round(1.0 * self.rate_hz)):
            now = self.tick(now)
            status |= self.read(drive, now, position, rate)
        assert status & Status.WATCHDOG
        drive.enable()
        status = self.read(
            drive, now, position, rate
        )  # as the loop does: in the same tick, before the table can have heard
        assert not status & Status.WATCHDOG
        assert bool(status & Status.UNCONFIRMED) is not bool(status & Status.ENABLED)
        sequence = 0
        while not status & Status.ENABLED:
            assert sequence < 2000
            now, sequence, status = self._hold(drive, now, start, 1, sequence)
            assert not status & Status.WATCHDOG
        drive.close()

    def test_disable_and_close_are_safe_at_any_time(self) -> None:
        """Twice, and before connecting."""
        drive = self.make_drive()
        drive.disable()
        drive.close()
        drive, _, _, _ = self._ready()
        for _ in range(2):
            drive.disable()
        for _ in range(2):
            drive.close()
