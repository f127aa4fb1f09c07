"""Deadlines are absolute, and what was slept through is left out."""

import time

import pytest

from fullpose_server.runtime.loop import clock
from fullpose_server.runtime.loop.clock import Deadlines, MadeUpClock


@pytest.fixture
def fake() -> MadeUpClock:
    return MadeUpClock()


def test_work_does_not_shift_the_deadlines(fake: MadeUpClock) -> None:
    deadlines = Deadlines(1_000_000, fake)
    begun = fake.now
    for tick in range(1, 100):
        now, lateness, missed = deadlines.wait()
        assert (now, lateness, missed) == (begun + tick * 1_000_000, 0, 0)
        fake.now += 300_000 + tick  # work


def test_missed_deadlines_are_counted_and_not_caught_up(fake: MadeUpClock) -> None:
    deadlines = Deadlines(1_000_000, fake)
    first, _, _ = deadlines.wait()
    fake.now += 3_400_000
    now, lateness, missed = deadlines.wait()
    assert (now - first, lateness, missed) == (3_400_000, 2_400_000, 2)
    now, lateness, missed = deadlines.wait()
    assert (now - first, lateness, missed) == (4_000_000, 0, 0)


def test_a_restart_forgets_the_pause(fake: MadeUpClock) -> None:
    deadlines = Deadlines(1_000_000, fake)
    deadlines.wait()
    fake.now += 700_000_000
    deadlines.restart()
    assert deadlines.wait()[1:] == (0, 0)


def test_health_says_why_there_is_no_real_time(monkeypatch: pytest.MonkeyPatch) -> None:
    assert clock.go_realtime(None, None).startswith("off: not asked")

    def refuse(*_: object) -> None:
        raise PermissionError(1, "Operation not permitted")

    monkeypatch.setattr(clock.os, "sched_setscheduler", refuse)
    told = clock.go_realtime(60, None)
    assert told.startswith("off: SCHED_FIFO refused")
    assert "CAP_SYS_NICE" in told


def test_the_real_clock_ticks_on() -> None:
    deadlines = Deadlines(2_000_000, clock.SystemClock())
    begun = time.monotonic_ns()
    ticks = 0
    for _ in range(20):
        _, _, missed = deadlines.wait()
        ticks += 1 + missed
    assert time.monotonic_ns() - begun >= ticks * 2_000_000
