"""Starting a rig process, from the one in reserve where there is one, and knowing how it ended."""

import asyncio
import json
import logging
import os
import signal
import time
from pathlib import Path

from fullpose_server.formats import durable
from fullpose_server.processes import START_S
from fullpose_server.runtime.contract import config as configs
from fullpose_server.runtime.contract.config import RigConfig
from fullpose_server.runtime.contract.hung import suspended
from fullpose_server.runtime.contract.rig_paths import RigPaths
from fullpose_server.runtime.supervisor.errors import HostError
from fullpose_server.runtime.supervisor.spare import Spare
from fullpose_server.runtime.supervisor.spawn import spawned

_ORDERS_S = 60.0  # for the one in reserve to take its orders: on a starved machine it is long in getting ready

log = logging.getLogger(__name__)


class Launcher:
    """Starts the processes of one rig, one after another."""

    def __init__(self, paths: RigPaths, spare: Spare | None) -> None:
        self._paths = paths
        self._spare = spare
        self._child = 0
        self._ended: int | None = None

    async def spawn(self, config: RigConfig) -> int:
        """Start a process with `config`; returns its pid when it is ready. Raises `HostError`."""
        self._paths.notes.unlink(missing_ok=True)
        await asyncio.to_thread(self._tell, config)
        try:
            await self._begun()
            await self._ready(config.name)
        finally:
            if self._spare is not None:
                self._spare.make_soon()
        return self._child

    def _tell(self, config: RigConfig) -> None:
        with durable.replacing(self._paths.config) as draft:
            draft.write_bytes(configs.encode(config))

    async def _ready(self, rig: str) -> None:
        """Wait until the child is. Raises `HostError`, and it is no more."""
        child = self._child
        deadline = time.monotonic() + START_S
        while time.monotonic() < deadline:
            if self.status(child) is not None:
                raise HostError(f"the rig process of {rig} ended at once:\n{self._log_end()}")
            if self._paths.running() == child:
                return
            await asyncio.sleep(0.02)
        os.kill(child, signal.SIGKILL)
        await self.reaped(child)
        raise HostError(f"the rig process of {rig} was not ready within {START_S:g} s:\n{self._log_end()}")

    def differences(self, config: RigConfig) -> list[str]:
        """The settings in which the process that was started here last is not as `config` has it."""
        wanted = json.loads(configs.encode(config))
        try:
            given = json.loads(self._paths.config.read_bytes())
        except (OSError, ValueError):
            given = {}
        names = (wanted.keys() | given.keys()) - {"after_loss", "shelves"}
        return sorted(name for name in names if wanted.get(name) != given.get(name))

    def status(self, pid: int) -> int | None:
        """How process `pid` ended (negative: by that signal); None while it lives, or where it is not ours to know."""
        if not pid or pid != self._child:
            return None
        if self._ended is None:
            found, status = os.waitpid(pid, os.WNOHANG)
            if found:
                self._ended = os.waitstatus_to_exitcode(status)
        return self._ended

    async def reaped(self, pid: int) -> None:
        """Wait until `pid`, which is at its end, is gone; returns at once where it is not our child."""
        if pid and pid == self._child and self.status(pid) is None:
            _, status = await asyncio.to_thread(os.waitpid, pid, 0)
            self._ended = os.waitstatus_to_exitcode(status)

    async def _begun(self) -> None:
        """Start a process: the one in reserve, or another where that does not take its orders."""
        self._ended = None
        self._child = 0 if self._spare is None else self._spare.take(self._paths)
        if self._child and not await self._obeys(self._child):
            log.warning("the rig process in reserve does nothing: it is ended, and another started")
            if self.status(self._child) is None:
                os.kill(self._child, signal.SIGKILL)
                await self.reaped(self._child)
            self._child, self._ended = 0, None
        if not self._child:
            self._child = self._started()

    async def _obeys(self, child: int) -> bool:
        """Whether it has begun to be the rig's: it takes the rig's lock."""
        deadline = time.monotonic() + _ORDERS_S
        while not self._paths.held():
            if self.status(child) is not None or suspended(child) or time.monotonic() > deadline:
                return False
            await asyncio.sleep(0.02)
        return True

    def _started(self) -> int:
        with self._paths.log.open("ab") as log, Path(os.devnull).open("rb") as nothing:
            return spawned(["--config", str(self._paths.config)], nothing.fileno(), log.fileno())

    def _log_end(self) -> str:
        return self._paths.log.read_text("utf-8", "replace")[-2000:]
