"""The server's side of a rig: its process started, commanded, and shown."""

import socket
from collections.abc import Coroutine
from dataclasses import replace
from typing import Any

from fullpose.rig import Rig
from fullpose_server.runtime.contract import messages
from fullpose_server.runtime.contract.config import RigConfig
from fullpose_server.runtime.contract.messages import Op, Request
from fullpose_server.runtime.contract.rig_paths import RigPaths
from fullpose_server.runtime.contract.shared_memory import Shared
from fullpose_server.runtime.contract.telemetry import Samples
from fullpose_server.runtime.supervisor.control_link import StandingLink
from fullpose_server.runtime.supervisor.errors import HostError, RefusedError, RigUnreachableError
from fullpose_server.runtime.supervisor.priority_channel import PriorityChannel
from fullpose_server.runtime.supervisor.process_manager import REPLY_S, ProcessManager
from fullpose_server.runtime.supervisor.process_view import ProcessView
from fullpose_server.runtime.supervisor.running import RunningProcesses
from fullpose_server.runtime.supervisor.spare import Spare
from fullpose_server.session.lease import Lease, LeaseAction, LeaseToken
from fullpose_server.session.states import Command

LOAD_S = 60.0  # a long plan is read and hashed


class RigHost:
    """One rig, as the server sees it. All methods belong to the event loop's thread; `estop` may come from any."""

    def __init__(self, config: RigConfig, running: RunningProcesses | None = None, spare: Spare | None = None) -> None:
        self.config = config
        self._paths = RigPaths(config.directory)
        self._view = ProcessView(config.name, config.rate_hz)
        self._link = StandingLink(self._paths)
        running = running or RunningProcesses()
        self._process = ProcessManager(config, self._paths, self._view, self._link, running, spare)
        self._priority = PriorityChannel(self._view)

    @property
    def name(self) -> str:
        """Of the rig."""
        return self.config.name

    @property
    def rig(self) -> Rig:
        """Its geometry and limits."""
        return self.config.rig

    # --- life ---

    async def start(self) -> None:
        """Spawn or adopt the rig process. Raises `HostError` where it does not come up."""
        await self._process.start()

    async def close(self, stop_rig: bool) -> None:
        """Let go of the rig process; with `stop_rig` end it: E-stop if it moves, then exit."""
        await self._process.close(stop_rig=stop_rig)

    @property
    def adopted(self) -> bool:
        """Whether the process was there already when the server came, and stayed."""
        return self._process.adopted

    def faults(self) -> list[str]:
        """What of the supervision itself has failed; nothing while all is well."""
        return self._process.faults()

    # --- commands ---

    async def command(
        self, command: str, args: dict[str, Any], who: str, lease: LeaseToken | None, key: str | None = None
    ) -> messages.Reply:
        """Do a session command (see server/fullpose_server/session/states.py). A refusal is a reply, not an exception.

        `key`: of the live source that is loaded. E-stop and stop take their priority channel here too, so that they
        never queue behind another command.
        """
        if command in (Command.STOP, Command.ESTOP):
            return await self.by_priority(Command(command), who)
        return (await self._ask(Request(0, Op.COMMAND, who, command, args, lease, key=key))).reply

    async def lease(self, action: LeaseAction, who: str, proof: str, to: str | None = None) -> Lease:
        """Do it under the proof of the lease's secret, or give the secret of `proof` (`GIVES_SECRET`).

        Raises `RefusedError` where it is refused.
        """
        answer = await self._ask(Request(0, Op.LEASE, who, action=action, to=to, proof=proof))
        if answer.reply.error is not None or answer.lease is None:
            raise RefusedError(answer.reply)
        return answer.lease

    async def lapse(self, holder: str) -> messages.Reply:
        """Take the lease from `holder`, who may command no longer; what they fly ends as after a silence, now."""
        return (await self._ask(Request(0, Op.LAPSE, holder))).reply

    async def prove_live(self, who: str, key: str) -> messages.Reply:
        """Whether `key` is that of the live source that is loaded: a refusal is a reply."""
        return (await self._ask(Request(0, Op.LIVE, who, key=key))).reply

    def estop(self, who: str) -> None:
        """E-stop, now: a flag in shared memory that the loop reads every tick. Never waits, never queues."""
        self._priority.flag(Command.ESTOP, who)

    async def stop(self, who: str) -> messages.Reply:
        """Stop inside the limits, by the priority channel; needs no lease."""
        return await self.by_priority(Command.STOP, who)

    def by_priority(self, command: Command, who: str) -> Coroutine[Any, Any, messages.Reply]:
        """E-stop or stop by its flag, now; the coroutine, which is to be awaited, only waits for the loop's answer."""
        return self._priority.ask(command, who)

    # --- what it shows ---

    @property
    def memory(self) -> Shared:
        """The memory shared with the rig process. Raises `HostError` before the first."""
        return self._view.memory

    def snapshot(self) -> messages.Snapshot:
        """The session as of now; of a dead process its last words, disconnected, with nothing allowed."""
        return self._view.snapshot()

    def samples(self, since_seq: int, limit: int) -> tuple[Samples, int]:
        """Telemetry after `since_seq`, oldest first, at most `limit`, and how many were lost to the reader."""
        return self._view.samples(since_seq, limit)

    def latest(self) -> Samples | None:
        """The newest sample (1,); None before the first."""
        return self._view.latest()

    def events(self, since: int) -> tuple[list[dict[str, Any]], int]:
        """The rig process's log events (commands, transitions, alarms), and where to ask from next."""
        return self._view.events(since)

    @property
    def rate_hz(self) -> float:
        """Of the loop that runs, whatever the settings say by now; of the settings before the first has run."""
        return self._view.rate_hz

    @property
    def revision(self) -> int:
        """Rises with every change that `snapshot` shows, over restarts of the rig process too."""
        return self._view.revision

    async def wait_change(self, revision: int) -> int:
        """Wait until the revision is not `revision`; returns the new one."""
        return await self._view.wait_change(revision)

    def live_socket(self) -> socket.socket:
        """A connected, non-blocking datagram socket to the rig's live source: samples in and replies back.

        For the WebSocket endpoint: `send(encode_sample(...))`, `recv(REPLY_SIZE)`; the caller closes it. Raises
        `HostError` where the rig process is not there.
        """
        made = socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM | socket.SOCK_CLOEXEC)
        made.setblocking(False)
        made.bind("")  # an abstract name of its own, so that replies find the way back
        try:
            with self._paths.socket_address("live.sock") as address:
                made.connect(address)
        except OSError as cause:
            made.close()
            raise HostError(f"{self.name}: no live source socket ({cause})") from cause
        return made

    async def _ask(self, asked: Request) -> messages.Answer:
        view, before = self._view, self._view.state()
        if view.dead:
            return messages.Answer(0, view.unreachable(before, asked.word, "the rig process is not running"))
        try:
            timeout_s = LOAD_S if asked.command == Command.LOAD else REPLY_S
            answer = await (await self._link.current()).request(asked, timeout_s=timeout_s)
        except RigUnreachableError as cause:
            return messages.Answer(0, view.unreachable(before, asked.word, str(cause)))
        return replace(answer, reply=replace(answer.reply, revision=view.revision_of(answer.reply.revision)))
