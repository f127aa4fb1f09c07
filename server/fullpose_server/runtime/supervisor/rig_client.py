"""The server's side of a rig process: spawn or adopt it, command it, watch it, read what it shows.

The rig process outlives the server. `RigHost.start` finds a living one by its lock and adopts it, session, lease,
alarms and all; otherwise it spawns one. One that runs by other settings than ours is replaced where nothing is bound
in it, else kept as it is. When the process dies the host says so at once (a pidfd tells), and starts another, which
comes up disconnected and carries the alarm.
"""

import asyncio
import contextlib
import logging
import os
import socket
import threading
import time
from collections.abc import Coroutine
from dataclasses import replace
from typing import Any

from fullpose_server.runtime.contract import messages
from fullpose_server.runtime.contract.config import RigConfig
from fullpose_server.runtime.contract.rig_paths import RigPaths
from fullpose_server.runtime.contract.shared_memory import Shared, SharedError
from fullpose_server.runtime.contract.telemetry import Samples
from fullpose_server.runtime.supervisor.control_link import ControlLink, RigUnreachableError
from fullpose_server.runtime.supervisor.health import beat_age_s, health_of
from fullpose_server.runtime.supervisor.process_manager import HostError, Launcher
from fullpose_server.session.lease import Lease, LeaseToken
from fullpose_server.session.states import Command, State
from fullpose_server.session.table import allowed

log = logging.getLogger(__name__)
REPLY_S = 5.0
LOAD_S = 60.0  # a live method that has not been used on this machine compiles first
_END_S = 15.0
_PUBLISH_S = 10.0
POLL_S = 0.005
BEAT_S = 0.05
SILENT_S = 0.15  # a rig heartbeat older than this counts as not responding
_RESPAWNS = 3  # in a minute; then a person must look


class RefusedError(Exception):
    """The rig process refused; `reply` has the code and what is allowed."""

    def __init__(self, reply: messages.Reply) -> None:
        super().__init__(reply.error.message if reply.error else "refused")
        self.reply = reply


class RigHost:
    """One rig, as the server sees it. All methods belong to the event loop's thread; `estop` may come from any."""

    def __init__(self, config: RigConfig) -> None:
        self.config = config
        self.name = config.name
        self.rig = config.rig
        self.adopted = False
        self._paths = RigPaths(config.directory)
        self._shared: Shared | None = None
        self._last: messages.Published | None = None
        self._link: ControlLink | None = None
        self._linking = asyncio.Lock()
        self._launcher = Launcher(self._paths)
        self._pid = 0
        self._pidfd = -1
        self._dead = True
        self._responding = True
        self._offset = 0  # keeps the revision rising over restarts of the process
        self._last_revision = -1
        self._changed = asyncio.Event()
        self._watch: asyncio.Task[None] | None = None
        self._ending = threading.Event()
        self._beat: threading.Thread | None = None
        self._respawned: list[float] = []

    # --- life ---

    async def start(self) -> None:
        """Spawn or adopt the rig process. Raises `HostError` where it does not come up."""
        self._paths.prepare()
        pid = self._paths.running()
        self.adopted = pid is not None
        if pid is None:
            pid = await self._launcher.spawn(self.config)
        await self._attach(pid)
        if self.adopted:
            await self._settle()
        self._beat = threading.Thread(target=self._beat_on, name=f"heartbeat to {self.name}", daemon=True)
        self._beat.start()
        self._watch = asyncio.create_task(self._watch_on(), name=f"watch {self.name}")

    async def _settle(self) -> None:
        """Replace an adopted process that runs by other settings, where nothing is bound in it; else say so."""
        other = self._launcher.differences(self.config)
        if not other:
            return
        names, published = ", ".join(other), self._published()
        if published.state not in (State.DISCONNECTED, State.IDLE) or published.alarms:
            log.warning("rig %s was adopted with other settings than the server's (%s): they stay", self.name, names)
            return
        log.info("rig %s ran by other settings than the server's (%s): it is started anew", self.name, names)
        await self._end_process()
        await self._detach()
        self.adopted = False
        await self._attach(await self._launcher.spawn(self.config))

    async def close(self, stop_rig: bool) -> None:
        """Let go of the rig process; with `stop_rig` end it: E-stop if it moves, then exit."""
        self._ending.set()
        if self._watch is not None:
            self._watch.cancel()
            await asyncio.gather(self._watch, return_exceptions=True)
        if stop_rig and self._link is not None and not self._dead:
            await self._end_process()
        await self._detach()
        if self._beat is not None:
            self._beat.join()

    async def _end_process(self) -> None:
        deadline = time.monotonic() + _END_S
        while not self._ended():
            # Refused while the rig moves, and answered with an E-stop: ask again when it is at rest.
            with contextlib.suppress(RigUnreachableError):
                await (await self._open_link()).request("exit", "server", timeout_s=REPLY_S)
            await asyncio.sleep(0.05)
            if time.monotonic() > deadline:
                raise HostError(f"rig process {self._pid} of {self.name} does not end")
        while not self._dead:  # it gives its lock up a little before it is gone
            await self._changed.wait()
        await self._launcher.reaped(self._pid)

    # --- commands ---

    async def command(self, command: str, args: dict[str, Any], who: str, lease: LeaseToken | None) -> messages.Reply:
        """Do a session command (see server/fullpose_server/session/states.py). A refusal is a reply, not an exception.

        E-stop and stop take their own channel here too, so that they never queue behind another command.
        """
        if command in (Command.STOP, Command.ESTOP):
            return await self.by_priority(Command(command), who)
        before = self._state()
        return (await self._ask(before, command, "command", who, command=command, args=args, lease=lease)).reply

    async def lease(self, action: str, who: str, to: str | None = None) -> Lease:
        """take, takeover (by force), release, renew, request, grant. Raises `RefusedError` where it is refused."""
        answer = await self._ask(self._state(), action, "lease", who, action=action, to=to)
        if answer.reply.error is not None or answer.lease is None:
            raise RefusedError(answer.reply)
        return answer.lease

    def estop(self, who: str) -> None:
        """E-stop, now: a flag in shared memory that the loop reads every tick. Never waits, never queues."""
        self._flag("estop", who)

    async def stop(self, who: str) -> messages.Reply:
        """Stop inside the limits, by the priority channel; needs no lease."""
        return await self.by_priority(Command.STOP, who)

    def by_priority(self, command: Command, who: str) -> Coroutine[Any, Any, messages.Reply]:
        """E-stop or stop by its flag, now; the coroutine, which is to be awaited, only waits for the loop's answer."""
        before = self._memory().snapshot(wait=False)  # microseconds; afterwards it may tell of the stop itself
        return self._priority_done(command, self._flag(command, who), before)

    # --- what it shows ---

    def snapshot(self) -> messages.Snapshot:
        """The session as of now; of a dead process its last words, disconnected, with nothing allowed."""
        published = self._published()
        alive = not self._dead and self._beat_age() < SILENT_S
        health = health_of(self._memory(), published, pid=self._pid, alive=alive, rate_hz=self.rate_hz)
        newest = self.latest()
        pose = [0.0] * 4 if newest is None else [float(v) for v in newest["measured"][0]]
        left = published.lease.expires_s
        if left is not None:
            heard = (time.monotonic_ns() - published.lease_heard_ns) / 1e9
            left = max(0.0, published.lease_silent_s - heard)
        state, can = (State.DISCONNECTED.value, []) if self._dead else (published.state, published.allowed)
        return messages.Snapshot(
            rig=published.rig,
            state=state,
            revision=published.revision + self._offset,
            allowed=can,
            lease=replace(published.lease, expires_s=left),
            plan=published.plan,
            alarms=published.alarms,
            history=published.history,
            run_id=published.run_id,
            drive=published.drive,
            health=health,
            pose_deg=pose,
        )

    def samples(self, since_seq: int, limit: int) -> tuple[Samples, int]:
        """Telemetry after `since_seq`, oldest first, at most `limit`, and how many were lost to the reader."""
        return self._memory().ring.since(since_seq, limit)

    def latest(self) -> Samples | None:
        """The newest sample (1,); None before the first."""
        return self._memory().ring.latest()

    def events(self, since: int) -> tuple[list[dict[str, Any]], int]:
        """What the rig process has noted (commands, transitions, alarms), and where to ask from next."""
        return self._memory().events_since(since)

    @property
    def rate_hz(self) -> float:
        """Of the loop that runs, whatever the settings say by now; of the settings before the first has run."""
        period_ns = 0 if self._shared is None else int(self._shared.header["period_ns"][0])
        return 1e9 / period_ns if period_ns else self.config.rate_hz

    @property
    def revision(self) -> int:
        """Rises with every change that `snapshot` shows, over restarts of the rig process too."""
        return self._offset if self._shared is None else int(self._shared.header["revision"][0]) + self._offset

    async def wait_change(self, revision: int) -> int:
        """Wait until the revision is not `revision`; returns the new one."""
        while self.revision == revision:
            changed = self._changed
            if self.revision == revision:
                await changed.wait()
        return self.revision

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

    # --- inside: process ---

    async def _attach(self, pid: int) -> None:
        link = ControlLink()
        try:
            shared = Shared(self._paths.memory())
            await link.open(self._paths)
            self._pidfd = os.pidfd_open(pid)
            deadline = time.monotonic() + _PUBLISH_S
            while shared.snapshot(wait=False) is None:  # ready, and about to say so
                if time.monotonic() > deadline:
                    raise SharedError("it publishes nothing")
                await asyncio.sleep(0.005)
        except (OSError, SharedError, RigUnreachableError) as cause:
            await self._detach()
            await link.close()
            raise HostError(f"the rig process {pid} of {self.name} cannot be adopted ({cause})") from cause
        self._pid, self._shared, self._link, self._dead = pid, shared, link, False
        shared.header["server_pid"] = os.getpid()
        shared.header["server_beat_ns"] = time.monotonic_ns()
        asyncio.get_running_loop().add_reader(self._pidfd, self._died)
        self._announce()

    async def _detach(self) -> None:
        if self._pidfd >= 0:
            asyncio.get_running_loop().remove_reader(self._pidfd)
            os.close(self._pidfd)
            self._pidfd = -1
        if self._link is not None:
            await self._link.close()

    def _died(self) -> None:
        asyncio.get_running_loop().remove_reader(self._pidfd)
        self._dead = True
        self._offset += 1
        self._announce()

    def _ended(self) -> bool:
        return self._launcher.status(self._pid) is not None or self._paths.running() != self._pid

    async def _revive(self) -> None:
        """Start another process in place of the dead one, with the cause as its first alarm."""
        now = time.monotonic()
        self._respawned = [t for t in self._respawned if now - t < 60.0]
        if len(self._respawned) >= _RESPAWNS:
            return
        self._respawned.append(now)
        last = self._published()
        how = ""
        code = self._launcher.status(self._pid)
        if code is not None:
            how = f" (signal {-code})" if code < 0 else f" (exit status {code})"
        why = "".join(f" ({a.message})" for a in last.alarms if a.code == "internal_error")
        told = f"the rig process died{how}{why} while {last.state}; the drive brakes by its own watchdog"
        await self._detach()
        last_revision = self.revision
        pid = self._paths.running()  # one that came up and could not be reached
        if pid is None:
            pid = await self._launcher.spawn(replace(self.config, after_loss=told))
        self._offset = last_revision + 1
        await self._attach(pid)

    async def _watch_on(self) -> None:
        while True:
            await asyncio.sleep(POLL_S)
            if self._dead:
                try:
                    await self._revive()
                except (HostError, OSError) as cause:
                    self._paths.log.open("a").write(f"server: {cause}\n")
                    await asyncio.sleep(1.0)
                continue
            responding = self._beat_age() < SILENT_S
            if responding != self._responding:
                self._responding = responding
                self._offset += 1
            if self.revision != self._last_revision:
                self._announce()

    def _announce(self) -> None:
        self._last_revision = self.revision
        changed, self._changed = self._changed, asyncio.Event()
        changed.set()

    def _beat_on(self) -> None:
        # A thread, because a heartbeat says that the process lives; whether the operator is there the lease tells.
        while not self._ending.wait(BEAT_S):
            shared = self._shared
            if shared is not None:
                shared.header["server_beat_ns"] = time.monotonic_ns()

    # --- inside: requests ---

    def _flag(self, channel: str, who: str) -> int:
        header = self._memory().header
        header[f"{channel}_who"] = who.encode()[:63]
        asked = time.monotonic_ns()
        header[f"{channel}_request_ns"] = asked
        return asked

    async def _priority_done(self, command: Command, asked: int, published: bytes | None) -> messages.Reply:
        header = self._memory().header
        told = self._published() if published is None else messages.decode_published(published)
        before = State.DISCONNECTED.value if self._dead else told.state
        deadline = time.monotonic() + REPLY_S
        while int(header[f"{command}_done_ns"][0]) < asked:
            if self._dead or time.monotonic() > deadline:
                return self._unreachable(
                    before, command, "the rig process does not answer; the drive's watchdog brakes"
                )
            await asyncio.sleep(0.001)
        after = self._state()
        if command in (Command.ESTOP, *allowed(State(before))):
            return messages.Reply(True, before, after, self.revision)
        can = [str(c) for c in allowed(State(before))]
        message = f"{command} is not possible while {before}; allowed now: {', '.join(can)}"
        body = messages.ErrorBody("illegal_command", message, before, command, can)
        return messages.Reply(False, before, after, self.revision, body)

    async def _open_link(self) -> ControlLink:
        """The link to the process, opened anew where it has broken. Raises `RigUnreachableError`."""
        async with self._linking:
            assert self._link is not None
            if not self._link.open_for_requests:
                link = ControlLink()
                await link.open(self._paths)
                await self._link.close()
                self._link = link
            return self._link

    async def _ask(self, before: str, word: str, op: str, who: str, **rest: Any) -> messages.Answer:
        if self._dead or self._link is None:
            return messages.Answer(0, self._unreachable(before, word, "the rig process is not running"))
        try:
            timeout_s = LOAD_S if word == Command.LOAD else REPLY_S
            answer = await (await self._open_link()).request(op, who, timeout_s=timeout_s, **rest)
        except RigUnreachableError as cause:
            return messages.Answer(0, self._unreachable(before, word, str(cause)))
        return replace(answer, reply=replace(answer.reply, revision=answer.reply.revision + self._offset))

    def _unreachable(self, before: str, command: str, message: str) -> messages.Reply:
        body = messages.ErrorBody("rig_unreachable", message, self._state(), command, [])
        return messages.Reply(False, before, self._state(), self.revision, body)

    # --- inside: reading ---

    def _memory(self) -> Shared:
        if self._shared is None:
            raise HostError(f"{self.name} has not been started")
        return self._shared

    def _published(self) -> messages.Published:
        data = self._memory().snapshot()
        if data is not None:
            self._last = messages.decode_published(data)
        if self._last is None:
            raise HostError(f"the rig process of {self.name} has published nothing")
        return self._last  # of a process that was killed while it published, what it had said before

    def _state(self) -> str:
        return State.DISCONNECTED.value if self._dead else self._published().state

    def _beat_age(self) -> float:
        return beat_age_s(self._memory())
