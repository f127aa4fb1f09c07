"""What rig, clock, recorder and live source did, weighed: each monitor takes data and returns violations."""

import math
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from fullpose._typing import Array
from fullpose.rig import FRAMES
from fullpose_server.drives.base import Status
from fullpose_server.drives.response_monitor import DriveResponseMonitor
from fullpose_server.runtime.contract.config import RigConfig, Tolerance
from fullpose_server.runtime.contract.hung import recorder_lost
from fullpose_server.runtime.live.source import LiveView
from fullpose_server.runtime.loop.loop_profile import STRICT, fitted
from fullpose_server.runtime.loop.watched_drive import DriveFailure
from fullpose_server.runtime.motion.limit_guard import Finding, Guard
from fullpose_server.session.states import Event
from fullpose_server.session.warning_codes import WarningCode

# As plain numbers: flags make an object of every "and", and this is asked a thousand times a second.
_LINK_LOST, _STALE_WRITE = int(Status.LINK_LOST), int(Status.STALE_WRITE)
_BROKEN = int(Status.FAULT | Status.ENCODER | Status.WATCHDOG)
_AT_REST = math.radians(0.5)  # [rad/s] a table slower than this that brakes by itself counts as stopped
_BRAKE_TIMEOUT_S = 5.0
_ORDER_S = 0.2  # for an order to reach the drive: the first move after arming is not far yet
_RETURN_S = 1.0  # a condition that was away for so long returns; one that flickers is the same
_PLAN_LATE_S = 0.5  # ten times as long as between two plans of a preview


@dataclass(frozen=True)
class Violation:
    """A finding and what follows: `event` is reported (None: only a warning), `drive_brakes` by its own means."""

    finding: Finding
    event: Event | None = None
    drive_brakes: bool = False


class DriveView(NamedTuple):
    """What a tick saw of the drive, and what is asked of it."""

    name: str
    status: int
    enabled: bool
    commanded: bool
    moving: bool
    measured: Array  # (4,) [rad]
    read_ms: float  # how long the read took that told it


def said(code: str, message: str, event: Event | None = None, *, drive_brakes: bool = False) -> Violation:
    """A violation without a figure."""
    finding = Finding(code, event is not None, message, None, math.nan, math.nan, "")
    return Violation(finding, event, drive_brakes)


def _words(status: int) -> str:
    """`Status` bits as the drive's author knows them."""
    return ", ".join(str(bit.name) for bit in Status if bit and status & bit) or "OK"


def weighed(found: Finding | None, *, drive_brakes: bool = False) -> list[Violation]:
    """A finding of the guard: brake, or warn; nothing found, nothing to do."""
    if found is None:
        return []
    return [Violation(found, Event.FAULT if found.trips else None, drive_brakes and found.trips)]


class Monitors:
    """Each method looks at one thing, once a tick or less, and remembers no more than it needs to say things once."""

    def __init__(self, config: RigConfig, guard: Guard) -> None:
        self._config = config
        self._guard = guard
        self._seen: dict[tuple[str, str | None], float] = {}  # when each condition was there last [s, monotonic]
        self._counted: dict[str, int] = {}
        self._misses: list[float] = []
        self._timing = fitted(config, STRICT).guard  # a configuration that has met no profile is held to the strict one
        self._response = DriveResponseMonitor(round(_ORDER_S * config.rate_hz))

    def forget(self) -> None:
        """Warn anew of what was warned of before: after a reset or unload."""
        self._seen.clear()
        self._counted.clear()
        self._response.forget()

    def begins(self, found: Finding, now: float) -> bool:
        """Whether the condition was not there for a while, `now` [s]: it begins, or returns."""
        key = (found.code, found.frame)
        last = self._seen.get(key, -math.inf)
        self._seen[key] = now
        return now - last > _RETURN_S

    def _more(self, code: str, count: int) -> bool:
        """Whether a count has grown since it was last looked at; one that is smaller has begun anew."""
        before = self._counted.get(code, 0)
        self._counted[code] = count
        return count > before

    def drive(self, seen: DriveView) -> list[Violation]:
        """The drive's own status, and whether it does what it was told."""
        status = seen.status
        disobeys = self._response.ends(seen.commanded, seen.moving, status)
        if status & _LINK_LOST:
            text = f"drive {seen.name}: read, {seen.read_ms:.3g} ms: link lost; the drive brakes by itself"
            return [said("link_lost", text, Event.LINK_LOST)]
        if seen.commanded and status & _BROKEN:
            return [self._drive_fault(seen)]
        if disobeys and seen.commanded:
            why = (
                "the order to enable was not confirmed"
                if status & Status.UNCONFIRMED
                else "it was enabled and confirmed it, and says no more that it is"
            )
            text = f"drive {seen.name} does not follow commands: {why} (read reports {_words(status)})"
            return [said("drive_not_enabled", text, Event.FAULT, drive_brakes=True)]
        if disobeys:
            why = "it still follows commands" if status & Status.ENABLED else "the order was not confirmed"
            text = f"drive {seen.name} was told to brake or power off: {why} (read reports {_words(status)})"
            return [said("drive_not_disabled", text, Event.FAULT)]
        if seen.enabled and status & _STALE_WRITE:
            return [said(WarningCode.STALE_WRITE, f"drive {seen.name}: write: refused as an old command")]
        return []

    def failed(self, failure: DriveFailure) -> Violation:
        """A call of the drive that raised: whatever it was asked is not done."""
        took_ms = failure.took_ns / 1e6
        return Violation(Finding("drive_failed", True, failure.cause, None, took_ms, math.nan, "ms"), Event.FAULT, True)

    def _drive_fault(self, seen: DriveView) -> Violation:
        status = seen.status
        word = "encoder" if status & Status.ENCODER else "watchdog" if status & Status.WATCHDOG else "fault"
        lost = np.flatnonzero(~np.isfinite(seen.measured))
        frame = FRAMES[int(lost[0])] if len(lost) else None
        which = "a frame that it does not name" if frame is None else f"the {frame} frame"
        told = {
            "encoder": f"no position from the encoder of {which}",
            "watchdog": "no command reached the drive in time: it brakes by itself",
            "fault": "the drive has a fault of its own",
        }[word]
        told = f"drive {seen.name}: read, {seen.read_ms:.3g} ms, reports {_words(status)}: {told}"
        return Violation(Finding(f"drive_{word}", True, told, frame, math.nan, math.nan, ""), Event.FAULT, True)

    def rests(self, rate: Array, braking_s: float) -> bool:
        """Whether a table that brakes by itself counts as stopped: rate (4,) [rad/s] measured, braking for so long."""
        return bool(np.abs(rate).max() < _AT_REST) or braking_s > _BRAKE_TIMEOUT_S

    def measured(
        self, measured: Array, due: Array, target: Array, live: LiveView | None
    ) -> tuple[float, list[Violation]]:
        """The tracking error [rad], nan where nothing is followed; `live` while a live source is followed."""
        error, findings = self._guard.measured(measured, due, target)
        violations: list[Violation] = []
        for found in findings:
            if found.code == "attitude_error" and live is not None:
                if not live.acquired:
                    continue  # still on the way from where the rig stood to where the source is
                if live.limited:
                    # The source asks for more than the limits allow, or has jumped after a gap: the rig does as it
                    # should, and is on its way to regain the attitude. Said, but no reason to stop.
                    violations.append(Violation(replace(found, trips=False)))
                    continue
            violations += weighed(found, drive_brakes=found.code == "following_error")
        return error, violations

    def lateness(self, now: float, lateness_ns: int, missed: int, *, moving: bool) -> list[Violation]:
        """Ticks that were late, and deadlines that were missed: what the drive did not hear in time."""
        guard, tolerances = self._guard, self._timing
        found: list[Violation] = []
        if moving:
            found += weighed(guard.scalar(WarningCode.LATENESS, lateness_ns / 1e6, tolerances.lateness_ms, "ms"))
        if missed:
            self._misses = [t for t in self._misses if now - t < 1.0] + [now] * min(missed, 5000)
            if moving:
                count = float(len(self._misses))
                found += weighed(guard.scalar(WarningCode.MISSED_DEADLINES, count, tolerances.misses_per_s, "in 1 s"))
        return found

    def recorder(self, now: float, header: NDArray[np.void]) -> list[Violation]:
        """A run goes on without its record, but not unsaid. `header` of the shared memory."""
        found = []
        error = bytes(header["recorder_error"][0])
        free, least = int(header["recorder_free_bytes"][0]) / 1e6, self._config.min_free_mb
        if recorder_lost(header, round(now * 1e9)):
            found.append(said(WarningCode.RECORDER_LOST, "the recorder does not run"))
        if error:
            found.append(said(WarningCode.RECORD_ERROR, error.decode("utf-8", "replace")))
        if 0 < free < least:
            text = f"{free:.0f} MB free where runs are recorded"
            found.append(Violation(Finding(WarningCode.DISK_LOW, False, text, None, free, least, "MB")))
        return found

    def live(self, live: LiveView, *, lost: bool) -> list[Violation]:
        """The live source's samples, and their age; `lost`: none came for too long, and the session stops the rig."""
        found: list[Violation] = []
        if live.heard:
            stale: Tolerance = self._config.guard.stale_ms
            found += weighed(self._guard.scalar(WarningCode.LIVE_SOURCE_STALE, live.age_ms, stale, "ms"))
        if live.plan_age_s > _PLAN_LATE_S:
            text = f"no way ahead from the planner for {live.plan_age_s:.1f} s: the step goes on without its foresight"
            age = live.plan_age_s * 1e3
            found.append(Violation(Finding(WarningCode.PREVIEW_LATE, False, text, None, age, _PLAN_LATE_S * 1e3, "ms")))
        unproven = "samples that do not prove to be of the source that was loaded: not used"
        second = "samples of a second live source, beside the one that is followed: not used"
        for count, code, text in (
            (live.bad, WarningCode.LIVE_BAD, "samples of the live source are none: not used"),
            (live.dropped, WarningCode.LIVE_DROPPED, "samples of the live source came late or twice: not used"),
            (live.clock_steps, WarningCode.LIVE_CLOCK_STEPS, "the live source began anew, or its clock was set"),
            (live.strangers, WarningCode.LIVE_SECOND_SOURCE, second),
            (live.unproven, WarningCode.LIVE_UNPROVEN, unproven),
        ):
            if self._more(code, count):
                found.append(said(code, text))
        if self._more(WarningCode.LIVE_IMPLAUSIBLE_RATE, live.implausible):
            text = f"a sample of the live source turns the body at {live.implausible_deg_s:.6g} deg/s: not used"
            value, limit = live.implausible_deg_s, live.plausible_deg_s
            found.append(
                Violation(Finding(WarningCode.LIVE_IMPLAUSIBLE_RATE, False, text, None, value, limit, "deg/s"))
            )
        if lost:
            text = f"no sample of the live source for {live.age_ms:.0f} ms"
            code = WarningCode.LIVE_SOURCE_LOST
            found.append(Violation(Finding(code, False, text, None, live.age_ms, math.nan, "ms")))
        return found
