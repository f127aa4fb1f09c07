"""The loop's profile: lenient for a simulated table without real time alone, and never against what a rig file says."""

from pathlib import Path

import pytest

from fullpose.rig import builtin_rigs
from fullpose_server.operating import GuardConfig, Tolerance
from fullpose_server.runtime.contract.config import RigConfig
from fullpose_server.runtime.loop.loop_profile import LENIENT, STRICT, LoopProfile, fitted, profile_of, told


def config(guard: GuardConfig = GuardConfig(), **options: float) -> RigConfig:  # noqa: B008 - frozen
    rig = builtin_rigs()["vertical-4"]
    return RigConfig("test", rig, Path(), Path(), guard=guard, drive_options=dict(options))


@pytest.mark.parametrize(
    ("drive", "realtime", "lenient"),
    [("simulated", False, True), ("simulated", True, False), ("udp", False, False), ("udp", True, False)],
)
def test_only_a_simulated_table_without_real_time_is_lenient(drive: str, realtime: bool, lenient: bool) -> None:
    assert (profile_of(drive, realtime=realtime) is LENIENT) is lenient


@pytest.mark.parametrize("profile", [STRICT, LENIENT])
def test_what_the_rig_file_does_not_say_is_the_profile_s(profile: LoopProfile) -> None:
    made = fitted(config(), profile)
    assert (made.guard.lateness_ms, made.guard.misses_per_s) == (profile.lateness_ms, profile.misses_per_s)
    assert made.drive_options == ({} if profile is STRICT else {"watchdog_s": 1.0})


@pytest.mark.parametrize("profile", [STRICT, LENIENT])
def test_what_it_says_stands(profile: LoopProfile) -> None:
    guard = GuardConfig(lateness_ms=Tolerance(None, 3.0), misses_per_s=Tolerance(None, None))
    said = config(guard, watchdog_s=0.2)
    assert fitted(said, profile) == said


def test_health_says_what_is_lost() -> None:
    assert told("on: SCHED_FIFO 60", STRICT) == "on: SCHED_FIFO 60"
    lost = told("off: not asked for", LENIENT)
    assert lost.startswith("off: not asked for. ")
    assert "a tick may be 1000 ms late (else 50)" in lost
