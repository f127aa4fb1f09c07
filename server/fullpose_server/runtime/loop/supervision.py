"""What one tick looks at: each monitor in its turn, a cause before its effects."""

import math
from collections.abc import Iterator
from typing import NamedTuple

from fullpose_server.runtime.loop.context import Parts
from fullpose_server.runtime.loop.monitors import DriveView, Monitors, Violation
from fullpose_server.runtime.motion.generator import Mode
from fullpose_server.session.machine import Silence
from fullpose_server.session.states import IN_MOTION, Event, State
from fullpose_server.session.warning_codes import WarningCode

_SLOWLY = 16  # ticks between two looks at what changes slowly: people, and the recorder


class Silent(NamedTuple):
    """A stage of somebody's silence is due."""

    code: str
    told: str
    event: Event


class Supervision:
    """Looks at one rig's parts; what it finds is acted on by who asked."""

    def __init__(self, parts: Parts, monitors: Monitors) -> None:
        self._parts = parts
        self._monitors = monitors
        self._server_silence = Silence(parts.config.server)

    def findings(self, now: float, lateness_ns: int, missed: int) -> Iterator[Violation]:
        """What rig, clock and recorder did. To be acted on one by one: a lost link is the last that the drive tells."""
        p, state, machine, monitors = self._parts, self._parts.state, self._parts.machine, self._monitors
        if machine.linked:
            failure = p.drive.failure()
            if failure is not None:
                yield monitors.failed(failure)
            commanded, moving, read_ms = state.commanded, machine.moving, p.drive.read_ns / 1e6
            seen = DriveView(p.drive.name, state.status, state.enabled, commanded, moving, state.measured, read_ms)
            yield from monitors.drive(seen)
        state.tracking_error = math.nan
        if state.commanded:
            motion = p.motion
            live = p.live.view() if motion.mode is Mode.LIVE else None
            state.tracking_error, found = monitors.measured(state.measured, motion.x1, motion.q1, live)
            yield from found
        yield from monitors.lateness(now, lateness_ns, missed, moving=state.enabled and machine.moving)
        if state.ticks % _SLOWLY == 0 and state.run_id is not None:
            yield from monitors.recorder(now, p.shared.header)

    def silences(self, now: float) -> Iterator[Silent]:
        """Who holds the lease, and the server: a silent one means hold, then stop, then disarm."""
        machine = self._parts.machine
        if self._parts.state.ticks % _SLOWLY or (machine.state not in IN_MOTION and machine.state is not State.ARMED):
            return
        for event in machine.silence(now):
            told = "may command no longer" if machine.lapsed else "is silent"
            yield Silent(WarningCode.OWNER_SILENT, f"the lease's holder {told}", self._kept(event))
        beat = int(self._parts.shared.header["server_beat_ns"][0]) / 1e9
        for event in self._server_silence.due(now - beat):
            yield Silent(WarningCode.SERVER_SILENT, "the server is silent", self._kept(event))

    def _kept(self, event: Event) -> Event:
        """The stage, or the next one: a hold on the path does not keep jerk limits, a stop does."""
        hold = event is Event.SILENT_HOLD and self._parts.config.rig.jerk_limited
        return Event.SILENT_STOP if hold else event
