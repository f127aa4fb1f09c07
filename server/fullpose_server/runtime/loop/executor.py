"""Does what the session ordered, all of it, in one match; and what follows from a finding.

The machine has decided, and what could fail was made ready before. What still fails in the doing (a drive that refuses
to be enabled) is a fault.
"""

import math
from collections.abc import Iterable
from dataclasses import asdict
from datetime import UTC, datetime
from typing import Any, TypeAlias, assert_never

import numpy as np

from fullpose._typing import Array
from fullpose.rig import FRAMES
from fullpose_server.drives.base import DriveError
from fullpose_server.runtime.loop.clock import seconds
from fullpose_server.runtime.loop.context import Parts
from fullpose_server.runtime.loop.monitors import Monitors, Violation, said
from fullpose_server.runtime.loop.orders import Load
from fullpose_server.runtime.motion.limit_guard import Finding
from fullpose_server.runtime.motion.point_to_point import PointMove
from fullpose_server.session import actions
from fullpose_server.session.alarms import Severity
from fullpose_server.session.run_end import Ending, RunEnd
from fullpose_server.session.states import IN_MOTION, Event, State
from fullpose_server.session.warning_codes import WarningCode

Order: TypeAlias = actions.Order[Load, PointMove]
_NOISE = math.radians(0.01)  # beyond a limit that an encoder may read at rest on it


class Executor:
    """Acts on one rig's parts; decides nothing."""

    def __init__(self, parts: Parts, monitors: Monitors) -> None:
        self._parts = parts
        self._monitors = monitors

    # --- orders ---

    def report(self, event: Event) -> None:
        """Tell the session what happened, and do what it orders."""
        machine = self._parts.machine
        before = machine.state
        self.do(machine.event(event))
        if machine.state is not before:
            self._parts.log.add("transition", before=before, after=machine.state, trigger=str(event))
        if event is Event.SOURCE_LOST and machine.state is not before:
            self.ends(Ending(RunEnd.SOURCE_LOST, WarningCode.LIVE_SOURCE_LOST))
        if event is Event.AT_REST:
            self.rest()

    def do(self, orders: tuple[Order, ...]) -> None:
        """Do the orders of one transition; and what every transition brings with it."""
        p, state = self._parts, self._parts.state
        for order in orders:
            self._do(order)
        if actions.BrakeFastest() in orders and not p.machine.moving:
            self.rest()
        if p.machine.state is not State.LIVE:
            p.live.end()
        if state.run_id is not None and p.machine.state not in IN_MOTION and not p.machine.moving:
            state.run_ends = True

    def _do(self, order: Order) -> None:
        p = self._parts
        match order:
            case actions.Bind(load=load):
                self._bind(load)
            case actions.Enable():
                self._enable()
            case actions.Position(move=move, who=who):
                p.motion.go(move, Event.AT_START)
                self._begin_run(who)
            case actions.Move(move=move):
                p.motion.go(move, Event.THERE)
            case actions.Run():
                p.motion.run()
            case actions.Hold():
                p.motion.hold(True)
            case actions.Resume():
                p.motion.hold(False)
            case actions.GoLive(who=who):
                p.live.begin(p.motion.x1, seconds(p.clock))
                p.motion.follow(p.live)
                self._begin_run(who)
            case actions.Brake():
                p.motion.brake(fastest=False)
            case actions.BrakeFastest():
                self._brake_fastest()
            case actions.DisableAtRest():
                p.state.disable_at_rest = True
            case actions.Disable():
                self._power_off()
            case actions.Unbind():
                p.motion.unload()
                p.live.unload()
                self._monitors.forget()
            case actions.Clear():
                self._monitors.forget()
                p.state.disable_at_rest = False
            case _:
                assert_never(order)

    def _bind(self, load: Load) -> None:
        p = self._parts
        p.state.plan = None if load.plan is None else load.plan.info
        p.state.plan_folder = load.folder
        if load.player is not None:
            p.motion.bind(load.player)
        if load.live is not None:
            p.live.bind(load.live)

    def _enable(self) -> None:
        p = self._parts
        try:
            p.drive.enable()
        except DriveError as cause:
            self.apply([said("drive_refused", str(cause), Event.FAULT)])
            return
        self._hold_position(p.state.measured)
        p.state.enabled, p.state.drive_brakes = True, False

    def _brake_fastest(self) -> None:
        if self._parts.state.commanded and self._parts.machine.moving:
            self._parts.motion.brake(fastest=True)

    def _hold_position(self, measured: Array) -> None:
        """Hold where the table is found, (4,) [rad]; a frame that lies outside its range by noise, on its limit."""
        rig = self._parts.config.rig
        pose = np.clip(measured, rig.position_min, rig.position_max)
        outside = np.abs(measured - pose)
        self._parts.motion.rest_at(np.where(outside <= _NOISE, pose, measured))
        for i in np.flatnonzero(outside > _NOISE):
            name, found, limit = FRAMES[i], math.degrees(measured[i]), math.degrees(pose[i])
            text = f"{name} frame found at {found:.6g} deg, beyond its limit of {limit:.6g} deg: it may only come back"
            self.apply([Violation(Finding(WarningCode.OUTSIDE_RANGE, False, text, name, found, limit, "deg"))])

    def _power_off(self) -> None:
        """Disable the drive; from here on the command is where the table stands."""
        self._parts.drive.disable()
        self._parts.state.enabled = self._parts.state.drive_brakes = False

    def let_drive_brake(self) -> None:
        """Commands cannot be trusted to reach the frames: the drive's own brakes must do it."""
        state = self._parts.state
        self._parts.drive.brake()
        state.drive_brakes = True
        state.drive_brakes_since = seconds(self._parts.clock)

    def rest(self) -> None:
        """At rest after an E-stop or a fault: brakes on."""
        p, state = self._parts, self._parts.state
        if state.disable_at_rest:
            self._power_off()
        elif p.machine.state is State.FAULTED and state.enabled:
            p.drive.brake()
            state.enabled = False

    # --- findings ---

    def apply(self, violations: Iterable[Violation]) -> None:
        """Warn when a condition begins or returns, or latch the fault and brake."""
        p = self._parts
        for each in violations:
            found = each.finding
            if each.event is None:
                if self._monitors.begins(found, seconds(p.clock)):
                    self._raise(found, Severity.WARNING)
                continue
            if each.event is Event.LINK_LOST:
                p.state.enabled = p.state.drive_brakes = False
            elif each.drive_brakes:
                self.let_drive_brake()
            self._raise(found, Severity.FAULT)
            how = RunEnd.LINK_LOST if each.event is Event.LINK_LOST else RunEnd.FAULT
            self.ends(Ending(how, found.code))
            self.report(each.event)
            if each.event is Event.LINK_LOST:
                p.drive.close()

    def silent(self, code: str, told: str, event: Event) -> None:
        """A stage of somebody's silence is due."""
        machine = self._parts.machine
        before = machine.state
        self.report(event)
        if machine.state is not before:
            if machine.state is State.STOPPING:
                self.ends(Ending(RunEnd(code), code))
            self.alarm(code, Severity.WARNING, f"{told}: {before} -> {machine.state}")

    def _raise(self, found: Finding, severity: Severity) -> None:
        value = found.value if math.isfinite(found.value) else None
        limit = found.limit if math.isfinite(found.limit) else None
        unit = found.unit or None
        self.alarm(found.code, severity, found.message, frame=found.frame, value=value, limit=limit, unit=unit)

    def alarm(self, code: str, severity: Severity, message: str, **evidence: Any) -> None:
        """Raise an alarm and log it."""
        p = self._parts
        p.machine.end_shelves(p.clock.steady_ns() / 1e9)
        raised = p.machine.alarm(code, severity, message, p.clock.wall_ns() / 1e9, **evidence)
        if raised.count == 1:
            if severity is not Severity.WARNING and p.state.run_id is None and p.state.ticks:
                # No run is recorded: the recorder keeps what led here (from the first tick on), and on until rest.
                who = p.machine.lease(seconds(p.clock)).holder or ""
                self._open_record("incident", f"{p.config.name}-incident", who=who, code=code)
            p.log.add("alarm", **asdict(raised))

    # --- the record ---

    def _begin_run(self, who: str) -> None:
        """A flight begins: the recorder opens a file."""
        state = self._parts.state
        state.run_id, state.run_ending = self._open_record("run_begin", self._parts.config.name, who=who), None

    def ends(self, ending: Ending) -> None:
        """Remember why the flight that is recorded, if there is one, is going to end."""
        state = self._parts.state
        if state.run_id is not None:
            state.run_ending = ending.after(state.run_ending)

    def end_run(self) -> None:
        """The flight that is recorded is over, with the sample that was published last."""
        p, state = self._parts, self._parts.state
        if state.run_id is None:
            return
        ending = state.run_ending or Ending(RunEnd.COMPLETED)
        ended = {"how": ending.how, "code": ending.code, "state": p.machine.state}
        p.log.add("run_end", run_id=state.run_id, head=p.shared.ring.head, **ended)
        state.run_id, state.run_ends = None, False

    def _open_record(self, kind: str, name: str, **content: Any) -> str:
        p = self._parts
        wall_ns = p.clock.wall_ns()
        stamp = datetime.fromtimestamp(wall_ns // 1_000_000_000, UTC).strftime("%Y%m%dT%H%M%S")
        run_id = f"{stamp}-{name}-{wall_ns // 1000 % 1000000:06d}"
        bound = p.machine.binding
        plan = {} if bound is None else asdict(bound)
        p.log.add(kind, run_id=run_id, rig=p.config.name, head=p.shared.ring.head, plan=plan, **content)
        return run_id
