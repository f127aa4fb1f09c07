"""What the processes of one rig show, one after another, by their shared memory.

The revision goes on rising from one process to the next, and with what only the server can know: that a process has
died, or does not respond.
"""

import asyncio
import time
from dataclasses import replace
from typing import Any

from fullpose_server.runtime.contract import drive_call, messages
from fullpose_server.runtime.contract.drive_call import HANGS, pending
from fullpose_server.runtime.contract.hung import is_silent, suspended
from fullpose_server.runtime.contract.shared_memory import Shared
from fullpose_server.runtime.contract.telemetry import Samples
from fullpose_server.runtime.supervisor.errors import HostError
from fullpose_server.runtime.supervisor.health import beat_age_s, health_of
from fullpose_server.session.alarms import Alarm, Severity
from fullpose_server.session.states import State


class ProcessView:
    """The newest process of rig `name`. Before the first, `rate_hz` is that of the settings."""

    def __init__(self, name: str, rate_hz: float) -> None:
        self._name = name
        self._settings_rate_hz = rate_hz
        self._pid = 0
        self._shared: Shared | None = None
        self._last: messages.Published | None = None
        self._dead = True
        self._responding = True
        self._offset = 0
        self._announced = -1
        self._changed = asyncio.Event()

    # --- what becomes of the process ---

    def attach(self, pid: int, shared: Shared) -> None:
        """Show process `pid` by its memory from now on."""
        self._offset = 0 if self._shared is None else self.revision + 1
        self._pid, self._shared, self._dead = pid, shared, False
        self._announce()

    def died(self) -> None:
        """The process is gone: its last words stay."""
        self._dead = True
        self._offset += 1
        self._announce()

    def poll(self) -> None:
        """Look whether there is anything new, and wake who waits for it."""
        responding = not self._silent()
        if responding != self._responding:
            self._responding = responding
            self._offset += 1
        if self.revision != self._announced:
            self._announce()

    async def wait_dead(self) -> None:
        """Wait until the process is gone."""
        while not self._dead:
            await self._changed.wait()

    # --- what it shows ---

    @property
    def pid(self) -> int:
        """Of the newest process, 0 before the first."""
        return self._pid

    @property
    def dead(self) -> bool:
        """Whether the process is gone, or there has been none."""
        return self._dead

    @property
    def memory(self) -> Shared:
        """The memory shared with the newest process. Raises `HostError` before the first."""
        if self._shared is None:
            raise HostError(f"{self._name} has not been started")
        return self._shared

    @property
    def rate_hz(self) -> float:
        """Of the loop that runs, whatever the settings say by now; of the settings before the first has run."""
        period_ns = 0 if self._shared is None else int(self._shared.header["period_ns"][0])
        return 1e9 / period_ns if period_ns else self._settings_rate_hz

    @property
    def revision(self) -> int:
        """Rises with every change that `snapshot` shows, over restarts of the rig process too."""
        return self._offset if self._shared is None else self.revision_of(int(self._shared.header["revision"][0]))

    def revision_of(self, told: int) -> int:
        """The revision that the newest process calls `told`."""
        return told + self._offset

    async def wait_change(self, revision: int) -> int:
        """Wait until the revision is not `revision`; returns the new one."""
        while self.revision == revision:
            changed = self._changed
            if self.revision == revision:
                await changed.wait()
        return self.revision

    def published(self) -> messages.Published:
        """The session as the process published it last. Raises `HostError` where it never did."""
        data = self.memory.snapshot()
        if data is not None:
            self._last = messages.decode_published(data)
        if self._last is None:
            raise HostError(f"the rig process of {self._name} has published nothing")
        return self._last  # of a process that was killed while it published, what it had said before

    def state(self) -> str:
        """Of the session."""
        return State.DISCONNECTED.value if self._dead else self.published().state

    def beat_age_s(self) -> float:
        """How long ago the process gave its last sign of life [s]."""
        return beat_age_s(self.memory)

    def samples(self, since_seq: int, limit: int) -> tuple[Samples, int]:
        """Telemetry after `since_seq`, oldest first, at most `limit`, and how many were lost to the reader."""
        return self.memory.ring.since(since_seq, limit)

    def latest(self) -> Samples | None:
        """The newest sample (1,); None before the first."""
        return self.memory.ring.latest()

    def events(self, since: int) -> tuple[list[dict[str, Any]], int]:
        """The rig process's log events (commands, transitions, alarms), and where to ask from next."""
        return self.memory.events_since(since)

    def snapshot(self) -> messages.Snapshot:
        """The session as of now; of a dead process its last words, disconnected, with nothing allowed."""
        published = self.published()
        alive = not self._dead and not self._silent()
        health = health_of(self.memory, published, pid=self._pid, alive=alive, rate_hz=self.rate_hz)
        newest = self.latest()
        pose = [0.0] * 4 if newest is None else [float(v) for v in newest["measured"][0]]
        left = published.lease.expires_s
        if left is not None:
            heard = (time.monotonic_ns() - published.lease_heard_ns) / 1e9
            left = max(0.0, published.lease_silent_s - heard)
        state, can = (State.DISCONNECTED.value, []) if self._dead else (published.state, published.allowed)
        return messages.Snapshot(
            rig=published.rig,
            life=published.life,
            state=state,
            revision=self.revision_of(published.revision),
            allowed=can,
            lease=replace(published.lease, expires_s=left),
            plan=published.plan,
            alarms=[*published.alarms, *self._hangs(published)],
            history=published.history,
            shelves=published.shelves,
            run_id=published.run_id,
            drive=published.drive,
            health=health,
            pose_deg=pose,
        )

    def unreachable(self, before: str, command: str, message: str) -> messages.Reply:
        """The reply to `command`, given in state `before`, of a process that cannot be reached."""
        body = messages.ErrorBody("rig_unreachable", message, self.state(), command, [])
        return messages.Reply(False, before, self.state(), self.revision, body)

    def _silent(self) -> bool:
        return is_silent(self.memory.header, time.monotonic_ns())

    def _hangs(self, published: messages.Published) -> list[Alarm]:
        """What a process cannot say itself whose drive keeps every thread of it from running."""
        call = None if self._dead or not self._silent() else pending(self.memory.header)
        if call is None or suspended(self._pid):
            return []
        message = drive_call.hanging(published.drive, call, time.monotonic_ns(), time.time_ns())
        braked = "no thread of its process runs, so its own watchdog must brake the table"
        number = 1 + max((alarm.number for alarm in published.history), default=0)
        chained = any(alarm.severity is not Severity.WARNING for alarm in published.alarms)
        since_s = time.time() - (time.monotonic_ns() - call.since_ns) / 1e9
        alarm = Alarm(number, HANGS, Severity.FAULT, f"{message}; {braked}", since_s, first=not chained)
        return [alarm]

    def _announce(self) -> None:
        if self._shared is not None:
            self._shared.header["revision_offset"] = self._offset
        self._announced = self.revision
        changed, self._changed = self._changed, asyncio.Event()
        changed.set()
