"""The rig processes of one server: adopted at start, started when a session is first wanted."""

import asyncio
import contextlib
import logging
from collections.abc import Callable
from pathlib import Path

from fullpose_server.formats.rig_file import RigStore
from fullpose_server.runtime.contract.config import RigConfig
from fullpose_server.runtime.contract.rig_paths import RigPaths
from fullpose_server.runtime.supervisor.errors import HostError
from fullpose_server.runtime.supervisor.rig_client import RigHost
from fullpose_server.runtime.supervisor.running import RunningProcesses
from fullpose_server.runtime.supervisor.spare import Spare
from fullpose_server.session.states import IN_MOTION

BRAKING_S = 15.0
log = logging.getLogger(__name__)


class RigHosts:
    """Hosts by rig name. A rig without a process is disconnected; commanding it or taking its lease starts one."""

    def __init__(
        self,
        rigs: RigStore,
        config: Callable[[str], RigConfig],
        directory: Callable[[str], Path],
        spare: Spare | None = None,
    ) -> None:
        self._rigs = rigs
        self._config = config
        self._directory = directory
        self._hosts: dict[str, RigHost] = {}
        self._starting: dict[str, asyncio.Task[RigHost]] = {}
        self._appeared = asyncio.Event()
        self._spare = spare
        self.running = RunningProcesses()

    def get(self, rig: str) -> RigHost | None:
        """The host of a rig, None where it has no process."""
        return self._hosts.get(rig)

    def all(self) -> list[RigHost]:
        """Every host there is."""
        return list(self._hosts.values())

    def state(self, rig: str) -> str:
        """Of a rig's session."""
        host = self._hosts.get(rig)
        return "disconnected" if host is None else host.snapshot().state

    async def ensure(self, rig: str) -> RigHost:
        """The host of a rig, started where there is none. Raises `NotFoundError`, `HostError`."""
        host = self._hosts.get(rig)
        if host is not None:
            return host
        starting = self._starting.get(rig)
        if starting is None:
            starting = self._starting[rig] = asyncio.create_task(self._start(rig), name=f"start {rig}")
            starting.add_done_callback(lambda task: self._started(rig, task))
        # Shielded: who asked may go, and the start is not left half done.
        return await asyncio.shield(starting)

    async def _start(self, rig: str) -> RigHost:
        host = RigHost(await asyncio.to_thread(self._config, rig), self.running, self._spare)
        await host.start()
        self._hosts[rig] = host
        appeared, self._appeared = self._appeared, asyncio.Event()
        appeared.set()
        return host

    def _started(self, rig: str, task: asyncio.Task[RigHost]) -> None:
        del self._starting[rig]
        if not task.cancelled():
            task.exception()  # told to who asked, where anybody is left

    async def wait(self, rig: str) -> RigHost:
        """The host of a rig, once there is one."""
        while (host := self._hosts.get(rig)) is None:
            await self._appeared.wait()
        return host

    async def adopt(self) -> None:
        """Take over the rig processes that an earlier server left."""
        for entry in await asyncio.to_thread(self._rigs.all):
            name = entry.rig.name
            if RigPaths(self._directory(name)).running() is not None:
                try:
                    await self.ensure(name)
                except HostError:
                    log.exception("rig %s runs, and could not be adopted", name)

    async def close(self, *, stop_rigs: bool) -> None:
        """Let go of all, ending their processes with `stop_rigs`."""
        await asyncio.gather(*self._starting.values(), return_exceptions=True)
        closing = [_close(host, stop_rigs) for host in self._hosts.values()]
        for result in await asyncio.gather(*closing, return_exceptions=True):
            if isinstance(result, BaseException):
                log.error("a rig did not close", exc_info=result)
        self._hosts.clear()
        if self._spare is not None:
            self._spare.close()


async def _close(host: RigHost, stop_rig: bool) -> None:
    """Close; a rig that is to end brakes inside its limits first."""
    if stop_rig and host.snapshot().state in IN_MOTION:
        await host.stop("server")
        with contextlib.suppress(TimeoutError):
            async with asyncio.timeout(BRAKING_S):
                while True:
                    revision = host.revision
                    if host.snapshot().state not in IN_MOTION:
                        break
                    await host.wait_change(revision)
    await host.close(stop_rig)
