"""The rig's loop: one tick after another, each on its deadline.

A tick: E-stop and stop flags, waiting commands, read the drive, judge what it did, propose the next command, guard it,
write it, record it. Nothing here blocks but what the session allows at rest (connecting, loading).
"""

import gc
import math
import subprocess
import time
from collections.abc import Callable
from dataclasses import asdict
from typing import Any

import numpy as np

from fullpose._typing import Array
from fullpose.rig import FRAMES
from fullpose_server.drives.base import Drive
from fullpose_server.formats.plan_folder import rig_hash
from fullpose_server.runtime.contract.config import RigConfig
from fullpose_server.runtime.contract.rig_paths import RigPaths
from fullpose_server.runtime.contract.shared_memory import Shared
from fullpose_server.runtime.live.source import LiveSource
from fullpose_server.runtime.loop.clock import Deadlines
from fullpose_server.runtime.loop.commands import CommandHandler
from fullpose_server.runtime.loop.control_server import ControlServer
from fullpose_server.runtime.loop.monitors import Monitors
from fullpose_server.runtime.loop.publisher import Publisher
from fullpose_server.runtime.motion.generator import Mode, Motion
from fullpose_server.runtime.motion.limit_guard import Finding, Guard
from fullpose_server.session.alarms import Severity
from fullpose_server.session.machine import SessionMachine
from fullpose_server.session.states import IN_MOTION, Action, Command, Event, State

_RAD = math.pi / 180.0
_AT_REST = 0.5 * _RAD  # [rad/s] a table slower than this that brakes by itself counts as stopped
_NOISE = 0.01 * _RAD  # [rad] beyond a limit that an encoder may read at rest on it
_BRAKE_TIMEOUT_S = 5.0
_COLLECT_S = 10.0


class RigLoop:
    """Everything one rig process does. `run` returns when the process should end."""

    def __init__(
        self,
        config: RigConfig,
        drive: Drive,
        shared: Shared,
        paths: RigPaths,
        realtime: str,
        start_recorder: Callable[[], "subprocess.Popen[bytes]"],
        recorder: "subprocess.Popen[bytes]",
    ) -> None:
        self.config = config
        self.rig = config.rig
        self.drive = drive
        self.shared = shared
        self.realtime = realtime
        self.dt = 1.0 / config.rate_hz
        self.deadlines = Deadlines(round(1e9 / config.rate_hz))
        self.machine = SessionMachine(config.rig.name, rig_hash(config.rig), config.owner)
        self.motion = Motion(config.rig, config.motion, config.rate_hz)
        self.guard = Guard(config.rig, config.guard, self.dt)
        self.enabled = False  # we write to the drive
        self.run_id: str | None = None
        self.ending = False
        self._ending_wanted = False
        self.measured = np.array(config.rig.home)
        self.measured_rate = np.zeros(4)
        self.drive_brakes = False  # the drive was told to brake by itself: our commands no longer count
        self._drive_brakes_since = 0.0
        self._disable_at_rest = False
        self._estop_unwritten = False
        self._obeyed: list[tuple[str, int]] = []  # E-stop and stop requests not answered yet
        self._start_recorder = start_recorder
        self._recorder = recorder
        self.status = 0
        self._sequence = 0
        self.ticks = 0
        self._collected = 0.0
        self._idle_since = time.monotonic()
        self._header = shared.header
        self.command_handler = CommandHandler(self)
        self.publisher = Publisher(self)
        self.monitors = Monitors(self)
        self.live = LiveSource(config.rig, config.live, paths, self.dt)
        self._control = ControlServer(paths, self.command_handler.answer)
        self._header["period_ns"] = self.deadlines.period_ns
        if config.after_loss is not None:
            self.alarm("rig_process_lost", Severity.FAULT, config.after_loss)

    # --- the loop ---

    def run(self) -> None:
        """Tick until told to end, or nobody needs this process any more."""
        self.publisher.publish()
        try:
            while not self.ending:
                now_ns, lateness_ns, missed = self.deadlines.wait()
                self.tick(now_ns, lateness_ns, missed)
        except BaseException as cause:
            self._fail(cause)
            raise
        self._control.close()
        self.live.close()
        self.drive.disable()
        self.drive.close()

    def _fail(self, cause: BaseException) -> None:
        """A fault of ours: nothing is commanded any more, so the drive brakes by itself, and the last words say why."""
        self.drive.brake()
        self.alarm("internal_error", Severity.FAULT, f"{type(cause).__name__}: {cause}")
        self.publisher.publish()

    def terminate(self) -> None:
        """On SIGTERM: E-stop where the rig moves; end when it is at rest."""
        self._ending_wanted = True

    def tick(self, now_ns: int, lateness_ns: int, missed: int) -> None:
        """One tick at `now_ns` [ns, monotonic]."""
        header = self._header
        now = now_ns / 1e9
        header["rig_beat_ns"] = now_ns
        self._lanes(now)
        self._control.poll()
        if self._ending_wanted:
            self._end_when_at_rest(now)
        self.status = self.drive.read(now, self.measured, self.measured_rate) if self.machine.linked else 0
        if self.machine.linked:
            self.monitors.drive()
        error = self.monitors.measured(now)
        self.monitors.lateness(now, lateness_ns, missed)
        self.live.poll(now)
        if self.ticks % 16 == 0:
            self.monitors.silences(now)
            self.monitors.recorder(now)
        self._move(now)
        self._answer_lanes()
        solved_deg = self.publisher.record(now_ns, lateness_ns, missed, error)
        self.live.reply(self.motion.x, solved_deg, self.guard.margin, time.monotonic())
        self.ticks += 1
        self._after(now, now_ns, lateness_ns)

    # --- orders ---

    def report(self, event: Event) -> None:
        """Tell the session what happened, and do what it orders."""
        before = self.machine.state
        self.do(self.machine.event(event))
        if self.machine.state is not before:
            self.log_event("transition", before=before, after=self.machine.state, trigger=str(event))

    def do(self, actions: tuple[Action, ...]) -> None:
        """Do what the session ordered. Orders that need arguments are prepared by the command handler."""
        for action in actions:
            match action:
                case Action.RUN:
                    self.motion.run()
                case Action.HOLD:
                    self.motion.hold(True)
                case Action.RESUME:
                    self.motion.hold(False)
                case Action.GO_LIVE:
                    self.live.begin(self.motion.x1, time.monotonic())
                    self.motion.follow(self.live)
                case Action.BRAKE:
                    self.motion.brake(fastest=False)
                case Action.BRAKE_FASTEST:
                    self._brake_fastest()
                case Action.DISABLE_AT_REST:
                    self._disable_at_rest = True
                case Action.DISABLE:
                    self.power_off()
                case Action.UNBIND:
                    self.motion.unload()
                    self.live.unload()
                    self.monitors.forget()
                case Action.CLEAR:
                    self.monitors.forget()
                    self._disable_at_rest = False
        if Action.BRAKE_FASTEST in actions and not self.machine.moving:
            self._rest()
        if self.machine.state is not State.LIVE:
            self.live.end()
        if self.run_id is not None and self.machine.state not in IN_MOTION and not self.machine.moving:
            self.log_event("run_end", run_id=self.run_id, head=self.shared.ring.head, state=self.machine.state)
            self.run_id = None

    def hold_position(self, measured: Array) -> None:
        """Stand where the table is found, (4,) [rad]; a frame that lies outside its range by noise, on its limit."""
        pose = np.clip(measured, self.rig.position_min, self.rig.position_max)
        outside = np.abs(measured - pose)
        self.motion.rest_at(np.where(outside <= _NOISE, pose, measured))
        for i in np.flatnonzero(outside > _NOISE):
            name, found, limit = FRAMES[i], math.degrees(measured[i]), math.degrees(pose[i])
            text = f"{name} frame found at {found:.6g} deg, beyond its limit of {limit:.6g} deg: it may only come back"
            self.monitors.warn(Finding("outside_range", False, text, name, found, limit, "deg"))

    def begin_run(self, who: str) -> None:
        """A flight begins: the recorder opens a file."""
        self.run_id = self._open_record("run_begin", self.config.name, who=who)

    def _open_record(self, kind: str, name: str, **content: Any) -> str:
        stamp = time.strftime("%Y%m%dT%H%M%S", time.gmtime())
        run_id = f"{stamp}-{name}-{time.time_ns() // 1000 % 1000000:06d}"
        bound = self.machine.binding
        plan = {} if bound is None else asdict(bound)
        self.log_event(kind, run_id=run_id, rig=self.config.name, head=self.shared.ring.head, plan=plan, **content)
        return run_id

    def estop_alarm(self, who: str) -> None:
        """The alarm of an E-stop."""
        self.alarm("estop", Severity.EMERGENCY, f"E-stop by {who or 'an unnamed operator'}")

    def power_off(self) -> None:
        """Disable the drive; from here on the command is where the table stands."""
        self.drive.disable()
        self.enabled = False
        self.drive_brakes = False

    def _brake_fastest(self) -> None:
        if self.enabled and not self.drive_brakes and self.machine.moving:
            self.motion.brake(fastest=True)

    def let_drive_brake(self, now: float) -> None:
        """Commands cannot be trusted to reach the frames: the drive's own brakes must do it."""
        self.drive.brake()
        self.drive_brakes = True
        self._drive_brakes_since = now

    def _rest(self) -> None:
        """At rest after an E-stop or a fault: brakes on."""
        if self._disable_at_rest:
            self.power_off()
        elif self.machine.state is State.FAULTED and self.enabled:
            self.drive.brake()
            self.enabled = False

    def _end_when_at_rest(self, now: float) -> None:
        if not self.machine.moving:
            self.ending = True
        elif self.machine.state is not State.ESTOPPED:
            self.command_handler.by_priority(Command.ESTOP, "SIGTERM", now)

    def _lanes(self, now: float) -> None:
        header = self._header
        for channel, command in (("estop", Command.ESTOP), ("stop", Command.STOP)):
            asked = int(header[f"{channel}_request_ns"][0])
            if asked == int(header[f"{channel}_done_ns"][0]):
                continue
            who = bytes(header[f"{channel}_who"][0]).decode("utf-8", "replace")
            self.command_handler.by_priority(command, who, now)
            self._obeyed.append((channel, asked))
            self._estop_unwritten = channel == "estop" or self._estop_unwritten

    def _answer_lanes(self) -> None:
        """Only after the first braking command is written; and who reads "done" must find the state it led to."""
        if self._obeyed:
            self.publisher.publish()
            for channel, asked in self._obeyed:
                self._header[f"{channel}_done_ns"] = asked
            self._obeyed.clear()

    # --- moving ---

    def _move(self, now: float) -> None:
        motion = self.motion
        if not self.enabled or self.drive_brakes:
            if np.isfinite(self.measured).all():
                motion.rest_at(self.measured)
            if self.machine.moving:
                stopped = np.abs(self.measured_rate).max() < _AT_REST
                if stopped or now - self._drive_brakes_since > _BRAKE_TIMEOUT_S:
                    self.report(Event.AT_REST)
                    self._rest()
            return
        event = motion.tick()
        if motion.mode is Mode.LIVE:
            self.monitors.live()
        if event is Event.SOURCE_LOST:
            text = f"no sample of the live source for {self.live.last_age_ms:.0f} ms"
            self.monitors.warn(Finding("live_source_lost", False, text, None, self.live.last_age_ms, math.nan, "ms"))
            self.report(event)
            event = motion.tick()
        found = self.guard.command(motion.x, motion.x1, motion.v1, motion.v, motion.a)
        if found is not None:
            event = None
            motion.brake(fastest=True)
            self.monitors.trip(found)
            if motion.tick() is Event.AT_REST:
                event = Event.AT_REST
            if self.guard.command(motion.x, motion.x1, motion.v1, motion.v, motion.a) is not None:
                self.let_drive_brake(now)  # not even braking is sound: nothing of ours is written
                return
        self._sequence += 1
        self.drive.write(motion.x, motion.v, motion.a, self.machine.epoch, self._sequence)
        motion.commit()
        if self._estop_unwritten:
            self._estop_unwritten = False
            self._header["estop_wrote_ns"] = time.monotonic_ns()
        if event is not None:
            self.report(event)
            if event is Event.AT_REST:
                self._rest()

    # --- telling ---

    def alarm(self, code: str, severity: Severity, message: str, **evidence: Any) -> None:
        """Raise an alarm and note it."""
        raised = self.machine.alarm(code, severity, message, time.time(), **evidence)
        if raised.count == 1:
            if severity is not Severity.WARNING and self.run_id is None and self.ticks:
                # No run is recorded: the recorder keeps what led here (from the first tick on), and on until rest.
                who = self.machine.lease(time.monotonic()).holder or ""
                self._open_record("incident", f"{self.config.name}-incident", who=who, code=code)
            self.log_event("alarm", **asdict(raised))

    def log_event(self, kind: str, **content: Any) -> None:
        """Add an event for the recorder and the server's audit log."""
        self.shared.add_event({"kind": kind, "time_ns": time.monotonic_ns(), "wall_ns": time.time_ns(), **content})

    def _after(self, now: float, now_ns: int, lateness_ns: int) -> None:
        header = self._header
        self.publisher.count(lateness_ns)
        self.publisher.refresh(now)
        resting = not self.machine.moving and self.machine.state is not State.ARMED
        if resting and now - self._collected > _COLLECT_S:
            self._at_leisure()
            self._collected = now
            self.deadlines.restart()
        if not resting or now - int(header["server_beat_ns"][0]) / 1e9 < 1.0:
            self._idle_since = now
        elif now - self._idle_since > self.config.exit_idle_s:
            self.log_event("exit", why=f"at rest, and no server for {self.config.exit_idle_s:g} s")
            self.ending = True
        busy = time.monotonic_ns() - now_ns
        header["busy_ns"] = (int(header["busy_ns"][0]) * 63 + busy) // 64

    def _at_leisure(self) -> None:
        """What only a rig at rest has time for."""
        gc.collect()
        if self._recorder.poll() is not None:
            self._recorder = self._start_recorder()
            self.log_event("recorder_restarted", pid=self._recorder.pid)
