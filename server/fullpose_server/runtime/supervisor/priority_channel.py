"""The priority channel: stop and E-stop by flags in shared memory, past every queue: the loop reads them every tick."""

import asyncio
import time
from collections.abc import Coroutine
from typing import Any

from fullpose_server.runtime.contract import messages
from fullpose_server.runtime.contract.memory_order import release
from fullpose_server.runtime.supervisor.process_view import ProcessView
from fullpose_server.session.errors import IllegalCommandError
from fullpose_server.session.states import Command, State
from fullpose_server.session.table import allowed

DONE_S = 5.0
_GONE = "the rig process does not answer; the drive's watchdog brakes"


class PriorityChannel:
    """Of the newest process of one rig. `flag` may be called from any thread."""

    def __init__(self, view: ProcessView) -> None:
        self._view = view

    def flag(self, command: Command, who: str) -> int:
        """Ask for `command`, now. Never waits, never queues. Returns when it was asked [ns, monotonic]."""
        header = self._view.memory.header
        header[f"{command}_who"] = who.encode()[:63]
        asked = time.monotonic_ns()
        release()
        header[f"{command}_request_ns"] = asked
        return asked

    def ask(self, command: Command, who: str) -> Coroutine[Any, Any, messages.Reply]:
        """Ask for `command`, now; the coroutine, which is to be awaited, only waits for the loop's answer."""
        before = self._view.memory.snapshot(wait=False)  # microseconds; afterwards it may tell of the stop itself
        return self._done(command, self.flag(command, who), before)

    async def _done(self, command: Command, asked: int, published: bytes | None) -> messages.Reply:
        view = self._view
        header = view.memory.header
        told = view.published() if published is None else messages.decode_published(published)
        before = State.DISCONNECTED if view.dead else State(told.state)
        deadline = time.monotonic() + DONE_S
        while int(header[f"{command}_done_ns"][0]) < asked:
            if view.dead or time.monotonic() > deadline:
                return view.unreachable(before.value, command, _GONE)
            await asyncio.sleep(0.001)
        after = view.state()
        can = allowed(before)
        if command in (Command.ESTOP, *can):
            return messages.Reply(True, before.value, after, view.revision)
        told_of = [str(c) for c in can]
        refusal = IllegalCommandError(before, command, can)
        body = messages.ErrorBody("illegal_command", str(refusal), before.value, command, told_of)
        return messages.Reply(False, before.value, after, view.revision, body)
