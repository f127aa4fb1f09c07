"""The rig's loop: one tick after another, each on its deadline.

A tick: priority channel, waiting commands, read the drive, supervise, propose the next command, guard it, write it,
publish it. Nothing here blocks but what the session allows at rest (connecting, loading).
"""

import math
from collections.abc import Callable
from typing import Protocol

import numpy as np

from fullpose_server.runtime.contract import messages
from fullpose_server.runtime.loop.clock import Deadlines, seconds
from fullpose_server.runtime.loop.commands import CommandHandler
from fullpose_server.runtime.loop.context import Parts
from fullpose_server.runtime.loop.executor import Executor
from fullpose_server.runtime.loop.leisure import Leisure
from fullpose_server.runtime.loop.monitors import DriveView, Monitors, Violation, weighed
from fullpose_server.runtime.loop.priority_channel import PriorityChannel
from fullpose_server.runtime.loop.publisher import Publisher
from fullpose_server.runtime.motion.generator import Mode
from fullpose_server.runtime.motion.limit_guard import Finding
from fullpose_server.session.alarms import Severity
from fullpose_server.session.machine import Silence
from fullpose_server.session.states import IN_MOTION, Command, Event, State

_AT_REST = math.radians(0.5)  # [rad/s] a table slower than this that brakes by itself counts as stopped
_BRAKE_TIMEOUT_S = 5.0


class Requests(Protocol):
    """Where commands come from."""

    def poll(self) -> None:
        """Have what is waiting answered, a little of it."""
        ...

    def close(self) -> None:
        """No more."""
        ...


Serve = Callable[[Callable[[messages.Request], messages.Answer]], Requests]


class ControlLoop:
    """One rig's loop. `run` returns when the process should end."""

    def __init__(self, parts: Parts, serve: Serve, leisure: Leisure) -> None:
        self._p = parts
        self._state = parts.state
        config = parts.config
        self._deadlines = Deadlines(round(1e9 / config.rate_hz), parts.clock)
        self._monitors = Monitors(config, parts.guard)
        self._executor = Executor(parts, self._monitors)
        self._publisher = Publisher(parts)
        self._commands = CommandHandler(parts, self._executor, self._publisher, self._deadlines)
        self._requests = serve(self._commands.answer)
        self._priority = PriorityChannel(parts.shared.header, parts.clock)
        self._leisure = leisure
        self._server_silence = Silence(config.server)
        self._ending_wanted = False
        self._sequence = 0
        parts.shared.header["period_ns"] = self._deadlines.period_ns
        if config.after_loss is not None:
            self._executor.alarm("rig_process_lost", Severity.FAULT, config.after_loss)

    def run(self) -> None:
        """Tick until told to end, or nobody needs this process any more."""
        self._publisher.publish()
        try:
            while not self._state.ending:
                self.tick(*self._deadlines.wait())
        except BaseException as cause:
            # A fault of ours: nothing is commanded any more, so the drive brakes by itself; the last words say why.
            self._p.drive.brake()
            self._executor.alarm("internal_error", Severity.FAULT, f"{type(cause).__name__}: {cause}")
            self._publisher.publish()
            raise
        self._requests.close()
        self._p.live.close()
        self._p.drive.disable()
        self._p.drive.close()

    def terminate(self) -> None:
        """On SIGTERM: E-stop where the rig moves; end when it is at rest."""
        self._ending_wanted = True

    def tick(self, now_ns: int, lateness_ns: int, missed: int) -> None:
        """One tick at `now_ns` [ns, monotonic]."""
        p, state = self._p, self._state
        now = now_ns / 1e9
        p.shared.header["rig_beat_ns"] = now_ns
        for command, who in self._priority.asked():
            self._commands.by_priority(command, who, now)
        self._requests.poll()
        if self._ending_wanted:
            self._end_when_at_rest(now)
        state.status = p.drive.read(now, state.measured, state.measured_rate) if p.machine.linked else 0
        self._supervise(now, lateness_ns, missed)
        if state.commanded:
            self._command()
        else:
            self._follow_table(now)
        if self._priority.waiting:
            self._publisher.publish()  # who reads "done" must find the state it led to
            self._priority.done()
        solved_deg = self._publisher.record(now_ns, lateness_ns, missed)
        p.live.reply(p.motion.x, solved_deg, p.guard.margin, seconds(p.clock))
        state.ticks += 1
        self._publisher.count(lateness_ns)
        self._publisher.refresh(now)
        if self._leisure.after_tick(now, p.machine.state, moving=p.machine.moving):
            self._deadlines.restart()
        state.ending = state.ending or self._leisure.unneeded
        self._publisher.busy(p.clock.monotonic_ns() - now_ns)

    def _end_when_at_rest(self, now: float) -> None:
        if not self._p.machine.moving:
            self._state.ending = True
        elif self._p.machine.state is not State.ESTOPPED:
            self._commands.by_priority(Command.ESTOP, "SIGTERM", now)

    def _supervise(self, now: float, lateness_ns: int, missed: int) -> None:
        """Every monitor looks at what it is there for, in the order in which a cause comes before its effects."""
        p, state, apply = self._p, self._state, self._executor.apply
        machine, motion, header = p.machine, p.motion, p.shared.header
        if machine.linked:
            name, commanded = p.drive.name, state.commanded
            seen = DriveView(name, state.status, state.enabled, commanded, machine.moving, state.measured)
            apply(self._monitors.drive(seen))
        state.tracking_error = math.nan
        if state.commanded:
            live = p.live.view() if motion.mode is Mode.LIVE else None
            state.tracking_error, found = self._monitors.measured(state.measured, motion.x1, motion.q1, live)
            apply(found)
        if missed:
            header["misses"] += missed
        apply(self._monitors.lateness(now, lateness_ns, missed, moving=state.enabled and machine.moving))
        p.live.poll(now)
        if state.ticks % 16 == 0:
            self._supervise_people(now)
            if state.run_id is not None:
                apply(self._monitors.recorder(now, header))

    def _supervise_people(self, now: float) -> None:
        """Who holds the lease, and the server: a silent one means hold, then stop, then disarm."""
        machine = self._p.machine
        if machine.state not in IN_MOTION and machine.state is not State.ARMED:
            return
        for event in machine.silence(now):
            self._executor.silent("owner_silent", "the lease's holder is silent", event)
        beat = int(self._p.shared.header["server_beat_ns"][0]) / 1e9
        for event in self._server_silence.due(now - beat):
            self._executor.silent("server_silent", "the server is silent", event)

    def _follow_table(self, now: float) -> None:
        """Nothing is commanded: the command is where the table stands, until it rests."""
        p, state = self._p, self._state
        if np.isfinite(state.measured).all():
            p.motion.rest_at(state.measured)
        if p.machine.moving:
            stopped = np.abs(state.measured_rate).max() < _AT_REST
            if stopped or now - state.drive_brakes_since > _BRAKE_TIMEOUT_S:
                self._executor.report(Event.AT_REST)
                self._executor.rest()

    def _command(self) -> None:
        """Propose the next command, guard it, write it; report what has happened by it."""
        p, motion = self._p, self._p.motion
        event = self._propose()
        found = self._guard()
        if found is not None:
            motion.brake(fastest=True)
            self._executor.apply(weighed(found))
            event = Event.AT_REST if motion.tick() is Event.AT_REST else None
            if self._guard() is not None:
                self._executor.let_drive_brake()  # not even braking is sound: nothing of ours is written
                return
        self._sequence += 1
        p.drive.write(motion.x, motion.v, motion.a, p.machine.epoch, self._sequence)
        motion.commit()
        self._priority.written()
        if event is not None:
            self._executor.report(event)
            if event is Event.AT_REST:
                self._executor.rest()

    def _propose(self) -> Event | None:
        p, motion = self._p, self._p.motion
        event = motion.tick()
        if motion.mode is Mode.LIVE:
            self._executor.apply(self._monitors.live(p.live.view()))
        if event is Event.SOURCE_LOST:
            age = p.live.last_age_ms
            text = f"no sample of the live source for {age:.0f} ms"
            lost = Finding("live_source_lost", False, text, None, age, math.nan, "ms")
            self._executor.apply([Violation(lost)])
            self._executor.report(event)
            event = motion.tick()
        return event

    def _guard(self) -> Finding | None:
        motion = self._p.motion
        return self._p.guard.command(motion.x, motion.x1, motion.v1, motion.v, motion.a)
