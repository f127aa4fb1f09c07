"""Judging what the rig, its clock, its recorder and its people did: warn, or latch a fault and brake."""

from __future__ import annotations

import math
import time
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from fullpose.rig import FRAMES
from fullpose_server.drives.base import Status
from fullpose_server.drives.response_monitor import DriveResponseMonitor
from fullpose_server.runtime.contract.config import Tolerance
from fullpose_server.runtime.motion.generator import Mode
from fullpose_server.runtime.motion.limit_guard import Finding
from fullpose_server.session.alarms import Severity
from fullpose_server.session.machine import Silence
from fullpose_server.session.states import IN_MOTION, Event, State

if TYPE_CHECKING:
    from fullpose_server.runtime.loop.control_loop import RigLoop

_RECORDER_SILENT_S = 1.0
_ORDER_S = 0.2  # for an order to reach the drive: the first move after arming is not far yet
_WAY_LATE_S = 0.5  # ten times as long as between two ways


class Monitors:
    """Judges for one loop. Each method looks at one thing, once a tick or less."""

    def __init__(self, loop: RigLoop) -> None:
        self._loop = loop
        self._warned: set[tuple[str, str | None]] = set()
        self._misses: list[float] = []
        self._server_silence = Silence(loop.config.server)
        self._drive_response = DriveResponseMonitor(round(_ORDER_S * loop.config.rate_hz))

    def forget(self) -> None:
        """Warn anew of what was warned of before: after a reset or unload."""
        self._warned.clear()
        self._drive_response.forget()

    def drive(self) -> None:
        """The drive's own status, and whether it does what it was told."""
        loop = self._loop
        status = loop.status
        now = time.monotonic()
        asked = loop.enabled and not loop.drive_brakes
        disobeys = self._drive_response.ends(asked, loop.machine.moving, status)
        if status & Status.LINK_LOST:
            loop.enabled = loop.drive_brakes = False
            loop.alarm("link_lost", Severity.FAULT, f"drive {loop.drive.name}: link lost; the drive brakes by itself")
            loop.report(Event.LINK_LOST)
            loop.drive.close()
        elif loop.enabled and not loop.drive_brakes and status & (Status.FAULT | Status.ENCODER | Status.WATCHDOG):
            word = "encoder" if status & Status.ENCODER else "watchdog" if status & Status.WATCHDOG else "fault"
            frame = None
            lost = np.flatnonzero(~np.isfinite(loop.measured))
            if len(lost):
                frame = FRAMES[int(lost[0])]
            told = {
                "encoder": f"{frame} frame: no position from its encoder",
                "watchdog": "no command reached the drive in time: it brakes by itself",
                "fault": "the drive reports a fault",
            }[word]
            loop.let_drive_brake(now)
            self.trip(Finding(f"drive_{word}", True, told, frame, math.nan, math.nan, ""))
        elif disobeys and asked:
            loop.let_drive_brake(now)
            why = "the order to enable was not confirmed" if status & Status.UNCONFIRMED else "it took the order"
            self.trip(
                _said("drive_not_enabled", f"drive {loop.drive.name} does not follow commands: {why}", trips=True)
            )
        elif disobeys:
            why = "it still follows commands" if status & Status.ENABLED else "the order was not confirmed"
            self.trip(
                _said(
                    "drive_not_disabled", f"drive {loop.drive.name} was told to brake or power off: {why}", trips=True
                )
            )
        elif loop.enabled and status & Status.STALE_WRITE:
            self.warn(_said("stale_write", "the drive refused an old command"))

    def measured(self, now: float) -> float:
        """The tracking error [rad]; nan where nothing is followed."""
        loop = self._loop
        motion = loop.motion
        if not loop.enabled or loop.drive_brakes:
            return math.nan
        error, findings = loop.guard.measured(loop.measured, motion.x1, motion.q1)
        for found in findings:
            if found.code == "attitude_error" and motion.mode is Mode.LIVE:
                if not loop.live.acquired:
                    continue  # still on the way from where the rig stood to where the source is
                if loop.live.limited:
                    # The source asks for more than the limits allow, or has jumped after a gap: the rig does as it
                    # should, and is on its way to regain the attitude. Said, but no reason to stop.
                    self.warn(replace(found, trips=False))
                    continue
            if found.trips and found.code == "following_error":
                loop.let_drive_brake(now)
            self.weigh(found)
        return error

    def lateness(self, now: float, lateness_ns: int, missed: int) -> None:
        """Ticks that were late, and deadlines that were missed: what the drive did not hear in time."""
        loop = self._loop
        moving = loop.enabled and loop.machine.moving
        if moving:
            self._weigh_scalar("lateness", lateness_ns / 1e6, loop.config.guard.lateness_ms, "ms")
        if missed:
            loop.shared.header["misses"] += missed
            self._misses = [t for t in self._misses if now - t < 1.0] + [now] * min(missed, 5000)
            if moving:
                count = float(len(self._misses))
                self._weigh_scalar("missed_deadlines", count, loop.config.guard.misses_per_s, "in 1 s")

    def recorder(self, now: float) -> None:
        """A run goes on without its record, but not unsaid."""
        loop = self._loop
        if loop.run_id is None:
            return
        header = loop.shared.header
        error = bytes(header["recorder_error"][0])
        free = int(header["recorder_free_bytes"][0]) / 1e6
        if now - int(header["recorder_beat_ns"][0]) / 1e9 > _RECORDER_SILENT_S:
            self.warn(_said("recorder_lost", "the recorder does not run"))
        if error:
            self.warn(_said("record_error", error.decode("utf-8", "replace")))
        if 0 < free < loop.config.min_free_mb:
            text = f"{free:.0f} MB free where runs are recorded"
            self.warn(Finding("disk_low", False, text, None, free, loop.config.min_free_mb, "MB"))

    def live(self) -> None:
        """The live source's samples, and their age."""
        loop = self._loop
        live = loop.live
        if live.heard:
            self._weigh_scalar("live_source_stale", live.last_age_ms, loop.config.guard.stale_ms, "ms")
        if live.way_age_s > _WAY_LATE_S:
            text = f"no way ahead from the planner for {live.way_age_s:.1f} s: the step goes on without its foresight"
            age = live.way_age_s * 1e3
            self.warn(Finding("preview_late", False, text, None, age, _WAY_LATE_S * 1e3, "ms"))
        counts = live.counts
        for word, text in (
            ("bad", "samples of the live source are none: not used"),
            ("dropped", "samples of the live source came late or twice: not used"),
            ("clock_steps", "the live source began anew, or its clock was set"),
        ):
            if counts[word]:
                self.warn(_said(f"live_{word}", text))
        if live.strangers:
            text = "samples of a second live source, beside the one that is followed: not used"
            self.warn(_said("live_second_source", text))

    def silences(self, now: float) -> None:
        """Who holds the lease, and the server: a silent one means hold, then stop, then disarm."""
        loop = self._loop
        owned = loop.machine.state in IN_MOTION or loop.machine.state is State.ARMED
        if not owned:
            return
        for event in loop.machine.silence(now):
            self._silent("owner_silent", "the lease's holder is silent", event)
        beat = int(loop.shared.header["server_beat_ns"][0]) / 1e9
        for event in self._server_silence.due(now - beat):
            self._silent("server_silent", "the server is silent", event)

    def _silent(self, code: str, told: str, event: Event) -> None:
        loop = self._loop
        before = loop.machine.state
        loop.report(event)
        if loop.machine.state is not before:
            loop.alarm(code, Severity.WARNING, f"{told}: {before} -> {loop.machine.state}")

    def _weigh_scalar(self, code: str, value: float, tolerance: Tolerance, unit: str) -> None:
        found = self._loop.guard.scalar(code, value, tolerance, unit)
        if found is not None:
            self.weigh(found)

    def weigh(self, found: Finding) -> None:
        """A finding of the guard: brake, or warn."""
        if found.trips:
            self.trip(found)
        else:
            self.warn(found)

    def trip(self, found: Finding) -> None:
        """Latch the fault and brake."""
        self._raise(found, Severity.FAULT)
        self._loop.report(Event.FAULT)

    def warn(self, found: Finding) -> None:
        """Raise a warning, once until a reset or unload."""
        if (found.code, found.frame) not in self._warned:
            self._warned.add((found.code, found.frame))
            self._raise(found, Severity.WARNING)

    def _raise(self, found: Finding, severity: Severity) -> None:
        value = found.value if math.isfinite(found.value) else None
        limit = found.limit if math.isfinite(found.limit) else None
        unit = found.unit or None
        self._loop.alarm(found.code, severity, found.message, frame=found.frame, value=value, limit=limit, unit=unit)


def _said(code: str, message: str, *, trips: bool = False) -> Finding:
    """A finding without a figure."""
    return Finding(code, trips, message, None, math.nan, math.nan, "")
