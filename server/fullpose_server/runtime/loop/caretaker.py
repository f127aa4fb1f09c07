"""What acts in the loop's place while the loop hangs in a call of its drive: a fault, the state, and stops answered."""

import math

from fullpose_server.runtime.contract import drive_call
from fullpose_server.runtime.contract.drive_call import Pending
from fullpose_server.runtime.loop.clock import seconds
from fullpose_server.runtime.loop.commands import CommandHandler
from fullpose_server.runtime.loop.context import Parts
from fullpose_server.runtime.loop.executor import Executor
from fullpose_server.runtime.loop.monitors import Violation
from fullpose_server.runtime.loop.priority_channel import PriorityChannel
from fullpose_server.runtime.loop.publisher import Publisher
from fullpose_server.runtime.motion.limit_guard import Finding
from fullpose_server.session.states import Event


class Caretaker:
    """Of one loop; called by `drive_watch`, on its thread, while that has the loop's turn."""

    def __init__(
        self,
        parts: Parts,
        executor: Executor,
        publisher: Publisher,
        commands: CommandHandler,
        priority: PriorityChannel,
    ) -> None:
        self._parts = parts
        self._executor = executor
        self._publisher = publisher
        self._commands = commands
        self._priority = priority

    def hangs(self, call: Pending, brake: str) -> None:
        """Name it, brake, publish; the sample of this tick, which the loop owes, goes into the record."""
        now_ns = self._parts.clock.monotonic_ns()
        took_ms = (now_ns - call.since_ns) / 1e6
        found = Finding(drive_call.HANGS, True, f"{self._said(call)}; {brake}", None, took_ms, math.nan, "ms")
        self._executor.apply([Violation(found, Event.FAULT, drive_brakes=self._parts.machine.linked)])
        self._publisher.record(now_ns, now_ns - call.since_ns, 1)
        self.tend()

    def tend(self) -> None:
        """A sign of life, and stops: their answer says the state they led to."""
        p = self._parts
        now_ns = p.clock.monotonic_ns()
        p.shared.header["rig_beat_ns"] = now_ns
        for command, who in self._priority.asked():
            self._commands.by_priority(command, who, now_ns / 1e9)
        self._publisher.publish()
        self._priority.done()

    def last(self, call: Pending) -> None:
        """The record's last words. The state stays as it was published: faulted."""
        self._executor.end_run()
        self._parts.log.add("exit", why=f"{self._said(call)}: the process is to be replaced")
        self._publisher.refresh(seconds(self._parts.clock))

    def _said(self, call: Pending) -> str:
        clock = self._parts.clock
        return drive_call.hanging(self._parts.drive.name, call, clock.monotonic_ns(), clock.wall_ns())
