"""The rig's loop: one tick after another, each on its deadline.

A tick: obey who asks, read the drive, supervise, propose the next command, guard it, write it, publish it. Parts return
what they found, the executor does what follows. Nothing blocks but what the session allows at rest (connect, load).
"""

import numpy as np

from fullpose_server.runtime.contract.messages import INTERNAL_ERROR
from fullpose_server.runtime.loop.caretaker import Caretaker
from fullpose_server.runtime.loop.clock import Deadlines, seconds
from fullpose_server.runtime.loop.commands import CommandHandler, Serve
from fullpose_server.runtime.loop.context import Parts
from fullpose_server.runtime.loop.executor import Executor
from fullpose_server.runtime.loop.leisure import Leisure
from fullpose_server.runtime.loop.monitors import Monitors, weighed
from fullpose_server.runtime.loop.priority_channel import PriorityChannel
from fullpose_server.runtime.loop.publisher import Publisher
from fullpose_server.runtime.loop.supervision import Supervision
from fullpose_server.runtime.motion.generator import Mode
from fullpose_server.runtime.motion.limit_guard import Finding
from fullpose_server.session.alarms import Severity
from fullpose_server.session.run_end import Ending, RunEnd
from fullpose_server.session.states import Event


class ControlLoop:
    """One rig's loop. `run` returns when the process should end."""

    def __init__(self, parts: Parts, serve: Serve, leisure: Leisure) -> None:
        self._p = parts
        self._deadlines = Deadlines(round(1e9 / parts.config.rate_hz), parts.clock)
        self._monitors = Monitors(parts.config, parts.guard)
        self._supervision = Supervision(parts, self._monitors)
        self._executor = Executor(parts, self._monitors)
        self._publisher = Publisher(parts)
        self._commands = CommandHandler(parts, self._executor, self._publisher, self._deadlines)
        self._requests = serve(self._commands.answer)
        self._priority = PriorityChannel(parts.shared.header, parts.clock)
        self.caretaker = Caretaker(parts, self._executor, self._publisher, self._commands, self._priority)
        self._leisure = leisure
        self._sequence = 0
        parts.shared.header["period_ns"] = self._deadlines.period_ns
        if parts.config.after_loss is not None:
            self._executor.alarm("rig_process_lost", Severity.FAULT, parts.config.after_loss)

    def run(self) -> None:
        """Tick until told to end, or nobody needs this process any more."""
        self._publisher.publish()
        try:
            while not (self._p.state.ending or self._leisure.unneeded):
                self.tick(*self._deadlines.wait())
        except BaseException as cause:
            # A fault of ours: nothing is commanded any more, so the drive brakes by itself; the last words say why.
            self._p.drive.brake()
            self._executor.alarm(INTERNAL_ERROR, Severity.FAULT, f"{type(cause).__name__}: {cause}")
            self._executor.ends(Ending(RunEnd.FAULT, INTERNAL_ERROR))
            self._publisher.record(self._p.clock.monotonic_ns(), 0, 0)  # the tick that failed
            self._executor.end_run()
            self._publisher.publish()
            raise
        self._requests.close()
        self._p.live.close()
        self._p.drive.disable()
        self._p.drive.close()

    def terminate(self) -> None:
        """On SIGTERM: E-stop where the rig moves; end when it is at rest."""
        self._commands.terminate()

    def tick(self, now_ns: int, lateness_ns: int, missed: int) -> None:
        """One tick at `now_ns` [ns, monotonic]."""
        now = now_ns / 1e9
        self._p.shared.header["rig_beat_ns"] = now_ns
        self._obey(now)
        self._read(now)
        self._supervise(now, lateness_ns, missed)
        if self._p.state.commanded:
            self._command()
        else:
            self._follow_table(now)
        self._publish(now_ns, lateness_ns, missed)
        if self._leisure.after_tick(now, self._p.machine.state, moving=self._p.machine.moving):
            self._deadlines.restart()
        self._publisher.busy(self._p.clock.monotonic_ns() - now_ns)

    def _obey(self, now: float) -> None:
        """Stop and E-stop first, then what waits in line."""
        for command, who in self._priority.asked():
            self._commands.by_priority(command, who, now)
        self._requests.poll()
        self._commands.end_where_asked(now)

    def _read(self, now: float) -> None:
        """What the drive measures, and the samples of a live source."""
        p, state = self._p, self._p.state
        state.status = p.drive.read(now, state.measured, state.measured_rate) if p.machine.linked else 0
        p.live.poll(now)

    def _supervise(self, now: float, lateness_ns: int, missed: int) -> None:
        """Act on each finding before the next is looked for: it may be of no matter then."""
        self._executor.apply(self._supervision.findings(now, lateness_ns, missed))
        for silent in self._supervision.silences(now):
            self._executor.silent(*silent)

    def _follow_table(self, now: float) -> None:
        """Nothing is commanded: the command is where the table stands, until it rests."""
        p, state = self._p, self._p.state
        if np.isfinite(state.measured).all():
            p.motion.rest_at(state.measured)
        if p.machine.moving and self._monitors.rests(state.measured_rate, now - state.drive_brakes_since):
            self._executor.report(Event.AT_REST)

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

    def _propose(self) -> Event | None:
        motion = self._p.motion
        event = motion.tick()
        if motion.mode is Mode.LIVE:
            self._executor.apply(self._monitors.live(self._p.live.view(), lost=event is Event.SOURCE_LOST))
        if event is Event.SOURCE_LOST:
            self._executor.report(event)
            event = motion.tick()
        return event

    def _guard(self) -> Finding | None:
        motion = self._p.motion
        return self._p.guard.command(motion.x, motion.x1, motion.v1, motion.v, motion.a, motion.jerk_from)

    def _publish(self, now_ns: int, lateness_ns: int, missed: int) -> None:
        """Tell who asked that it is done, the record, and the live source."""
        p = self._p
        if self._priority.waiting:
            self._publisher.publish()  # who reads "done" must find the state it led to
            self._priority.done()
        solved_deg = self._publisher.record(now_ns, lateness_ns, missed)
        if p.state.run_ends:
            self._executor.end_run()
        p.live.reply(p.motion.x, solved_deg, p.guard.margin, seconds(p.clock))
        self._p.state.ticks += 1
        self._publisher.count(lateness_ns, missed)
        self._publisher.refresh(now_ns / 1e9)
