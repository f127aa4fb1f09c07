"""What the monitors makes of late ticks: each tolerance by itself, and no warning in the way of a trip."""

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from fullpose.rig import builtin_rigs
from fullpose_server.runtime.contract.config import GuardConfig, Tolerance
from fullpose_server.runtime.contract.shared_memory import HEADER
from fullpose_server.runtime.loop.monitors import Monitors
from fullpose_server.runtime.motion.limit_guard import Guard
from fullpose_server.session.alarms import Severity
from fullpose_server.session.machine import SilencePolicy
from fullpose_server.session.states import Event

OFF = Tolerance(None, None)


class Loop:
    """As much of a loop as lateness needs, moving; `raised` is what was told."""

    def __init__(self, guard: GuardConfig) -> None:
        self.config = SimpleNamespace(guard=guard, server=SilencePolicy(), rate_hz=1000.0)
        self.guard = Guard(builtin_rigs()["vertical-4"], guard, 1e-3)
        self.shared = SimpleNamespace(header=np.zeros(1, HEADER))
        self.machine = SimpleNamespace(moving=True)
        self.enabled = True
        self.raised: list[tuple[str, Severity]] = []
        self.reported: list[Event] = []

    def alarm(self, code: str, severity: Severity, message: str, **evidence: Any) -> None:  # noqa: ARG002
        self.raised.append((code, severity))

    def report(self, event: Event) -> None:
        self.reported.append(event)


def run(guard: GuardConfig, ticks: int, lateness_ms: float, missed: int) -> Loop:
    loop = Loop(guard)
    monitors = Monitors(loop)  # type: ignore[arg-type]
    for tick in range(ticks):
        monitors.lateness(tick * 1e-3 * (1 + missed), round(lateness_ms * 1e6), missed)
    return loop


def test_a_loop_that_is_a_little_late_all_the_time_trips_by_its_misses() -> None:
    loop = run(GuardConfig(), 200, 4.5, 4)
    assert ("lateness", Severity.WARNING) in loop.raised
    assert ("missed_deadlines", Severity.FAULT) in loop.raised
    assert Event.FAULT in loop.reported
    assert loop.shared.header["misses"][0] == 800


def test_one_tick_that_is_very_late_trips_by_itself() -> None:
    loop = run(GuardConfig(), 1, 60.0, 59)
    assert ("lateness", Severity.FAULT) in loop.raised


@pytest.mark.parametrize(("trip", "expected"), [(0.0, [Event.FAULT]), (None, []), (0.2, [])])
def test_zero_is_a_tolerance_of_lateness_and_none_is_off(trip: float | None, expected: list[Event]) -> None:
    guard = GuardConfig(lateness_ms=Tolerance(None, trip), misses_per_s=OFF)
    assert run(guard, 1, 0.1, 0).reported == expected


def test_a_rig_that_rests_may_be_late() -> None:
    loop = Loop(GuardConfig())
    loop.machine.moving = False
    Monitors(loop).lateness(0.0, 10**9, 1000)  # type: ignore[arg-type]
    assert loop.raised == []
    assert loop.shared.header["misses"][0] == 1000
