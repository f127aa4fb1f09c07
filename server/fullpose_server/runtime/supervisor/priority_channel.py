"""The priority channel: stop and E-stop by flags in shared memory, past every queue: the loop reads them every tick."""

import asyncio
import time
from collections.abc import Coroutine
from typing import Any, Protocol

from fullpose_server.runtime.contract import messages
from fullpose_server.runtime.contract.memory_order import release
from fullpose_server.runtime.contract.shared_memory import Shared
from fullpose_server.runtime.supervisor.health import beat_age_s
from fullpose_server.session.errors import IllegalCommandError
from fullpose_server.session.states import Command, State
from fullpose_server.session.table import allowed

DONE_S = 0.2  # an operator must not wait longer for what is not known; the order stands all the same
POLL_S = 0.001


class RunningRig(Protocol):
    """The newest process of one rig, as who asks it to stop sees it."""

    @property
    def memory(self) -> Shared:
        """Shared with the process."""

    @property
    def dead(self) -> bool:
        """Whether it is gone."""

    @property
    def revision(self) -> int:
        """Of the session, over restarts of the process too."""

    def state(self) -> str:
        """Of the session."""


class PriorityChannel:
    """Of the newest process of one rig. `flag` may be called from any thread."""

    def __init__(self, rig: RunningRig) -> None:
        self._rig = rig

    def flag(self, command: Command, who: str) -> int:
        """Ask for `command`, now. Never waits, never queues. Returns when it was asked [ns, monotonic]."""
        header = self._rig.memory.header
        header[f"{command}_who"] = who.encode("utf-8", "replace")[:63]
        asked = time.monotonic_ns()
        release()
        header[f"{command}_request_ns"] = asked
        return asked

    def ask(self, command: Command, who: str) -> Coroutine[Any, Any, messages.Reply]:
        """Ask for `command`, now; the coroutine, which is to be awaited, only waits for the loop's answer.

        Never refused because the process cannot be reached: after `DONE_S` the reply says what is not known.
        """
        before = self._rig.memory.snapshot(wait=False)  # microseconds; afterwards it may tell of the stop itself
        return self._done(command, self.flag(command, who), before)

    async def _done(self, command: Command, asked: int, published: bytes | None) -> messages.Reply:
        rig = self._rig
        header = rig.memory.header
        told = rig.state() if published is None else messages.decode_published(published).state
        before = State.DISCONNECTED if rig.dead else State(told)
        deadline = asked + round(DONE_S * 1e9)
        while int(header[f"{command}_done_ns"][0]) < asked:
            if rig.dead or time.monotonic_ns() > deadline:
                return messages.Reply(True, before.value, rig.state(), rig.revision, unknown=self._unknown())
            await asyncio.sleep(POLL_S)
        after = rig.state()
        can = allowed(before)
        if command in (Command.ESTOP, *can):
            return messages.Reply(True, before.value, after, rig.revision)
        told_of = [str(c) for c in can]
        refusal = IllegalCommandError(before, command, can)
        body = messages.ErrorBody("illegal_command", str(refusal), before.value, command, told_of)
        return messages.Reply(False, before.value, after, rig.revision, body)

    def _unknown(self) -> str:
        header = self._rig.memory.header
        age, pid = beat_age_s(self._rig.memory), int(header["rig_pid"][0])
        if self._rig.dead:
            return (
                f"the rig process {pid} has ended, its last sign of life is {age:.2f} s old: nothing commands the "
                "drive, whose own watchdog brakes; whether the frames rest is not known"
            )
        return (
            f"the order stands in the memory of rig process {pid}, which has not answered within {DONE_S * 1e3:g} ms; "
            f"its last sign of life is {age:.2f} s old: whether the frames brake is not known"
        )
