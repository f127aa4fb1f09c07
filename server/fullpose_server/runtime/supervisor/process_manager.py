"""The life of a rig's process: spawned or adopted, watched, started anew where it dies, ended.

The process outlives the server. A living one is found by its lock and adopted, session, lease, alarms and all. One
that runs by other settings than ours is replaced where nothing is bound in it, else kept as it is. A pidfd tells at
once when it dies; the next comes up disconnected and carries the alarm. One that hangs for good is killed.
"""

import asyncio
import contextlib
import logging
import os
import signal
import time
from dataclasses import replace
from pathlib import Path

from fullpose_server.processes import START_S, how_it_ended, memory_kills
from fullpose_server.runtime.contract import messages
from fullpose_server.runtime.contract.config import RigConfig
from fullpose_server.runtime.contract.drive_call import HANGS
from fullpose_server.runtime.contract.hung import Hung
from fullpose_server.runtime.contract.rig_paths import RigPaths
from fullpose_server.runtime.contract.shared_memory import Shared, SharedError
from fullpose_server.runtime.supervisor.control_link import StandingLink
from fullpose_server.runtime.supervisor.errors import HostError, RigUnreachableError
from fullpose_server.runtime.supervisor.heartbeat import Heartbeat
from fullpose_server.runtime.supervisor.launcher import Launcher
from fullpose_server.runtime.supervisor.process_view import ProcessView
from fullpose_server.runtime.supervisor.running import RunningProcess, RunningProcesses
from fullpose_server.runtime.supervisor.spare import Spare
from fullpose_server.session.states import State

log = logging.getLogger(__name__)
REPLY_S = 5.0
POLL_S = 0.005
_HUNG_LOOKS, _PATIENT_LOOKS = 200, 4000  # a second, and twenty, of a server that is on time
_END_S = 15.0
_PUBLISH_S = 10.0
_RESPAWNS = 3  # in a minute; then a person must look
_RETRY_S = 1.0


class ProcessManager:
    """Of one rig. Keeps `view` on the newest process, and `link` to it."""

    def __init__(
        self,
        config: RigConfig,
        paths: RigPaths,
        view: ProcessView,
        link: StandingLink,
        running: RunningProcesses,
        spare: Spare | None = None,
    ) -> None:
        self._config = config
        self._paths = paths
        self._view = view
        self._link = link
        self._running = running
        self._launcher = Launcher(paths, spare)
        self._adopted = False
        self._pidfd = -1
        self._respawned: list[float] = []
        self._hung = Hung(_HUNG_LOOKS, _PATIENT_LOOKS)
        self._killed = ""  # why, where we did it
        self._memory_kills = 0  # of the system, up to the newest process's beginning
        self._refused = ""  # why no other could be started in its place
        self._watch: asyncio.Task[None] | None = None
        self._heartbeat: Heartbeat | None = None

    @property
    def adopted(self) -> bool:
        """Whether the first process was there already, and stayed."""
        return self._adopted

    def faults(self) -> list[str]:
        """What of the supervision itself has failed; nothing while all is well."""
        found = []
        if self._refused:
            found.append(f"its process cannot be started: {self._refused}")
        if self._watch is not None and self._watch.done():
            found.append("its process is not watched any more")
        if self._heartbeat is not None and not self._heartbeat.alive:
            found.append("its process hears no heartbeat of the server")
        return found

    async def start(self) -> None:
        """Spawn or adopt the process. Raises `HostError` where it does not come up."""
        self._paths.prepare()
        pid = await self._there()
        self._adopted = pid is not None
        if pid is None:
            pid = await self._launcher.spawn(self._config)
        await self._attach(pid)
        if self._adopted:
            await self._settle()
        self._heartbeat = Heartbeat(self._view, self._config.name)
        self._watch = asyncio.create_task(self._watch_on(), name=f"watch {self._config.name}")
        self._watch.add_done_callback(self._watch_ended)

    async def _there(self) -> int | None:
        """The process that is there already; one that an earlier server has started, and that gets ready, is awaited.

        A second beside it could only end at its lock, and would have taken its notes and configuration away.
        """
        deadline = time.monotonic() + START_S
        while (pid := self._paths.running()) is None and self._paths.held():
            if time.monotonic() > deadline:
                raise HostError(f"a process has the lock of {self._config.name}, and is not ready in {START_S:g} s")
            await asyncio.sleep(0.02)
        return pid

    async def close(self, *, stop_rig: bool) -> None:
        """Let go of the process; with `stop_rig` end it: E-stop if it moves, then exit."""
        if self._watch is not None:
            self._watch.cancel()
            await asyncio.gather(self._watch, return_exceptions=True)
            self._watch = None
        heartbeat, self._heartbeat = self._heartbeat, None
        try:
            if stop_rig and not self._view.dead:
                await self._end()
        finally:
            await self._detach()
            self._running.left(self._config.name)
            if heartbeat is not None:
                heartbeat.stop()

    async def _attach(self, pid: int) -> None:
        try:
            shared = Shared(self._paths.memory())
            await self._link.current()
            self._pidfd = os.pidfd_open(pid)
            deadline = time.monotonic() + _PUBLISH_S
            while shared.snapshot(wait=False) is None:  # ready, and about to say so
                if time.monotonic() > deadline:
                    raise SharedError("it publishes nothing")
                await asyncio.sleep(0.005)
        except (OSError, SharedError, RigUnreachableError) as cause:
            await self._detach()
            raise HostError(f"the rig process {pid} of {self._config.name} cannot be adopted ({cause})") from cause
        shared.header["server_pid"] = os.getpid()
        shared.header["server_beat_ns"] = time.monotonic_ns()
        asyncio.get_running_loop().add_reader(self._pidfd, self._died)
        self._view.attach(pid, shared)
        self._memory_kills = memory_kills()
        self._running.came(RunningProcess(self._config.name, pid, self._paths.memory()))

    async def _detach(self) -> None:
        if self._pidfd >= 0:
            asyncio.get_running_loop().remove_reader(self._pidfd)
            os.close(self._pidfd)
            self._pidfd = -1
        await self._link.close()

    def _died(self) -> None:
        asyncio.get_running_loop().remove_reader(self._pidfd)
        self._view.died()

    async def _settle(self) -> None:
        """Replace an adopted process that runs by other settings, where nothing is bound in it; else say so."""
        other = self._launcher.differences(self._config)
        if not other:
            return
        rig, names, published = self._config.name, ", ".join(other), self._view.published()
        if published.state not in (State.DISCONNECTED, State.IDLE) or published.alarms:
            log.warning("rig %s was adopted with other settings than the server's (%s): they stay", rig, names)
            return
        log.info("rig %s ran by other settings than the server's (%s): it is started anew", rig, names)
        try:
            await self._end()
        finally:
            await self._detach()
        self._adopted = False
        await self._attach(await self._launcher.spawn(self._config))

    async def _end(self) -> None:
        deadline = time.monotonic() + _END_S
        pid = self._view.pid
        while self._launcher.status(pid) is None and self._paths.running() == pid:
            # Refused while the rig moves, and answered with an E-stop: ask again when it is at rest.
            with contextlib.suppress(RigUnreachableError):
                asked = messages.Request(0, messages.Op.EXIT, "server")
                await (await self._link.current()).request(asked, timeout_s=REPLY_S)
            await asyncio.sleep(0.05)
            if time.monotonic() > deadline and not self._killed:
                self._kill(" (it did not end when it was told)")
        await self._view.wait_dead()  # it gives its lock up a little before it is gone
        await self._launcher.reaped(pid)

    async def _watch_on(self) -> None:
        while True:
            await asyncio.sleep(POLL_S)
            if not self._view.dead:
                self._view.poll()
                self._end_hung()
                continue
            try:
                await self._revive()
            except (HostError, OSError) as cause:
                self._refused = str(cause)
                log.warning("rig %s is not started anew: %s", self._config.name, cause)
                await asyncio.to_thread(_append, self._paths.log, f"server: {cause}\n")
                await asyncio.sleep(_RETRY_S)

    def _end_hung(self) -> None:
        """Kill a process that hangs for good; that it is gone, the pidfd tells."""
        newest = self._view.latest()
        state = None if newest is None else int(newest["state"][0])
        if self._killed or not self._hung.look(self._view.memory.header, self._view.pid, state, time.monotonic_ns()):
            return
        why = "".join(f" ({a.message})" for a in self._view.snapshot().alarms if a.code == HANGS)
        self._kill(why or " (it gave no sign of life, and was in no call of its drive)")

    def _kill(self, why: str) -> None:
        self._killed = why
        log.error("rig %s: process %d hangs and is killed%s", self._config.name, self._view.pid, why)
        with contextlib.suppress(ProcessLookupError):
            signal.pidfd_send_signal(self._pidfd, signal.SIGKILL)

    def _watch_ended(self, watch: asyncio.Task[None]) -> None:
        if not watch.cancelled():
            log.error("rig %s is not watched any more", self._config.name, exc_info=watch.exception())

    async def _revive(self) -> None:
        """Start another process in place of the dead one, with the cause as its first alarm."""
        now = time.monotonic()
        self._respawned = [t for t in self._respawned if now - t < 60.0]
        if len(self._respawned) >= _RESPAWNS:
            self._refused = self._refused or f"{_RESPAWNS} have ended within a minute; after it another is tried"
            return
        self._respawned.append(now)
        last = self._view.published()
        code = self._launcher.status(self._view.pid)
        how = "" if code is None else f" ({how_it_ended(code, self._memory_kills, memory_kills())})"
        lost = _loss(last, how, self._killed)
        self._killed = ""
        await self._detach()
        pid = self._paths.running()  # one that came up and could not be reached
        if pid is None:
            pid = await self._launcher.spawn(replace(self._config, after_loss=lost, shelves=tuple(last.shelves)))
        await self._attach(pid)
        self._refused = ""


def _loss(last: messages.Published, how: str, killed: str) -> str:
    """What is said of a process that died; `how`, where that is known; `killed` is why we did it, where we did."""
    why = killed or "".join(f" ({a.message})" for a in last.alarms if a.code in (messages.INTERNAL_ERROR, HANGS))
    return f"the rig process died{how}{why} while {last.state}; the drive brakes by its own watchdog"


def _append(path: Path, text: str) -> None:
    with contextlib.suppress(OSError), path.open("a") as file:  # a full disk, say: the server's own log has it too
        file.write(text)
