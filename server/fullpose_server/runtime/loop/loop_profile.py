"""How late the loop may be: its profile, by what the machine grants and what hangs on it.

A table is braked where its loop is late: 50 ms without a word, or a fifth of the deadlines missed within a second. That
needs real-time scheduling; a busy machine without it is later than that every few seconds. Where the table is
simulated, a late tick costs nothing but the time that a flight takes: without real-time rights the profile is lenient.
What a rig file says stands in either, and the loop of a real table is strict wherever it runs.
"""

from dataclasses import dataclass, replace

from fullpose_server.operating import Tolerance
from fullpose_server.runtime.contract.config import RigConfig

SIMULATED = "simulated"
WATCHDOG = "watchdog_s"  # the simulated table's: how long it waits for a command before it brakes by itself


@dataclass(frozen=True)
class LoopProfile:
    """The tolerances that hold where a rig file has none; `watchdog_s` is None where the drive's own is kept."""

    lateness_ms: Tolerance
    misses_per_s: Tolerance
    watchdog_s: float | None = None


STRICT = LoopProfile(Tolerance(2.0, 50.0), Tolerance(20.0, 200.0))
LENIENT = LoopProfile(Tolerance(50.0, 1000.0), Tolerance(200.0, None), watchdog_s=1.0)


def profile_of(drive: str, *, realtime: bool) -> LoopProfile:
    """The profile of a loop with this drive."""
    return LENIENT if drive == SIMULATED and not realtime else STRICT


def fitted(config: RigConfig, profile: LoopProfile) -> RigConfig:
    """`config` with the profile's values where it says none."""
    guard, options = config.guard, config.drive_options
    if profile.watchdog_s is not None:
        options = {WATCHDOG: profile.watchdog_s} | options
    return replace(
        config,
        guard=replace(
            guard,
            lateness_ms=guard.lateness_ms or profile.lateness_ms,
            misses_per_s=guard.misses_per_s or profile.misses_per_s,
        ),
        drive_options=options,
    )


def told(realtime: str, profile: LoopProfile) -> str:
    """What the system granted, and what is lost where the profile is lenient for it."""
    if profile is STRICT:
        return realtime
    late, strict = profile.lateness_ms.trip, STRICT.lateness_ms.trip
    return (
        f"{realtime}. The table is simulated, so the loop's profile is lenient: a tick may be {late:g} ms late (else "
        f"{strict:g}) and any number of deadlines be missed; a flight takes longer by each, and is no measure of timing"
    )
