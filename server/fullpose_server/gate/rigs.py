"""The rigs whose processes run, as the gate sees them: by their shared memory, which no disk and no server delays."""

import asyncio
import contextlib
import os
from collections.abc import Callable, Coroutine
from pathlib import Path
from typing import Any

from fullpose_server.api.stopping import NOTHING_RUNS, audit_entry
from fullpose_server.runtime.contract import messages
from fullpose_server.runtime.contract.shared_memory import Shared
from fullpose_server.runtime.supervisor.priority_channel import PriorityChannel
from fullpose_server.session.states import Command, State
from fullpose_server.store.audit_entry import AuditEntry


class RunningRig:
    """The newest process of one rig."""

    def __init__(self, pid: int, memory: Shared) -> None:
        self.memory = memory
        self._pidfd = os.pidfd_open(pid)
        self._dead = False
        asyncio.get_running_loop().add_reader(self._pidfd, self._died)

    @property
    def dead(self) -> bool:
        """Whether the process is gone."""
        return self._dead

    @property
    def revision(self) -> int:
        """As the server counts it, over restarts of the process."""
        return int(self.memory.header["revision"][0]) + int(self.memory.header["revision_offset"][0])

    def state(self) -> str:
        """Of the session, as the process told it last."""
        told = None if self._dead else self.memory.snapshot(wait=False)
        return State.DISCONNECTED.value if told is None else messages.decode_published(told).state

    def close(self) -> None:
        """Look at it no more."""
        if not self._dead:
            self._died()

    def _died(self) -> None:
        asyncio.get_running_loop().remove_reader(self._pidfd)
        os.close(self._pidfd)
        self._dead = True


class Rigs:
    """By name. `audit` is told of every stop, after its answer is known."""

    def __init__(self, audit: Callable[[AuditEntry], None]) -> None:
        self._audit = audit
        self._running: dict[str, RunningRig] = {}

    def __contains__(self, rig: str) -> bool:
        return rig in self._running

    def runs(self, rig: str, pid: int, memory: Path) -> None:
        """A process runs for the rig; of one that is gone already the last word stays."""
        with contextlib.suppress(OSError):
            process = RunningRig(pid, Shared(memory))
            self.left(rig)
            self._running[rig] = process

    def left(self, rig: str) -> None:
        """The server has let go of it."""
        process = self._running.pop(rig, None)
        if process is not None:
            process.close()

    def close(self) -> None:
        """Look at none any more."""
        for rig in list(self._running):
            self.left(rig)

    def stop(self, rig: str, command: Command, who: str, address: str | None) -> Coroutine[Any, Any, messages.Reply]:
        """Stop or E-stop: the order stands when this returns; the coroutine, to be awaited, waits for the reply."""
        process = self._running.get(rig)
        done = None if process is None else PriorityChannel(process).ask(command, who)

        async def replied() -> messages.Reply:
            reply = NOTHING_RUNS if done is None else await done
            self._audit(audit_entry(rig, who, command, reply, address=address))
            return reply

        return replied()
