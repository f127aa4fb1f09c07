"""What the monitors make of late ticks: each tolerance by itself, and no warning in the way of a trip."""

from pathlib import Path

import pytest

from fullpose.rig import builtin_rigs
from fullpose_server.runtime.contract.config import GuardConfig, RigConfig, Tolerance
from fullpose_server.runtime.loop.monitors import Monitors, Violation
from fullpose_server.runtime.motion.limit_guard import Guard
from fullpose_server.session.states import Event

OFF = Tolerance(None, None)


def run(guard: GuardConfig, ticks: int, lateness_ms: float, missed: int, *, moving: bool = True) -> list[Violation]:
    """What is found in so many ticks."""
    rig = builtin_rigs()["vertical-4"]
    monitors = Monitors(RigConfig("test", rig, Path(), Path(), guard=guard), Guard(rig, guard, 1e-3))
    found = []
    for tick in range(ticks):
        now = tick * 1e-3 * (1 + missed)
        found += monitors.lateness(now, round(lateness_ms * 1e6), missed, moving=moving)
    return found


def told(found: list[Violation]) -> set[tuple[str, Event | None]]:
    return {(each.finding.code, each.event) for each in found}


def test_a_loop_that_is_a_little_late_all_the_time_trips_by_its_misses() -> None:
    found = told(run(GuardConfig(), 200, 4.5, 4))
    assert ("lateness", None) in found
    assert ("missed_deadlines", Event.FAULT) in found


def test_one_tick_that_is_very_late_trips_by_itself() -> None:
    assert ("lateness", Event.FAULT) in told(run(GuardConfig(), 1, 60.0, 59))


@pytest.mark.parametrize(("trip", "expected"), [(0.0, [Event.FAULT]), (None, []), (0.2, [])])
def test_zero_is_a_tolerance_of_lateness_and_none_is_off(trip: float | None, expected: list[Event]) -> None:
    guard = GuardConfig(lateness_ms=Tolerance(None, trip), misses_per_s=OFF)
    assert [each.event for each in run(guard, 1, 0.1, 0)] == expected


def test_a_rig_that_rests_may_be_late() -> None:
    assert run(GuardConfig(), 1, 1000.0, 1000, moving=False) == []
