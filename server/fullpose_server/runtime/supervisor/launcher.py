"""Starting a rig process, and knowing how it ended.

Spawned, not a `Popen`: the rig process outlives the server that started it, by design, and a `Popen` that is dropped
while its process runs takes that for a leak.
"""

import asyncio
import json
import os
import signal
import sys
import time
from pathlib import Path

import fullpose
import fullpose_server
from fullpose_server.runtime.contract import config as configs
from fullpose_server.runtime.contract.config import RigConfig
from fullpose_server.runtime.contract.rig_paths import RigPaths
from fullpose_server.runtime.supervisor.errors import HostError

START_S = 180.0  # with no kernel in the cache, compiling takes most of it
# The process runs the very packages that run here, wherever they were found.
_ROOTS = [str(Path(*package.__path__).resolve().parent) for package in (fullpose_server, fullpose)]


class Launcher:
    """Starts the processes of one rig, one after another."""

    def __init__(self, paths: RigPaths) -> None:
        self._paths = paths
        self._child = 0
        self._ended: int | None = None

    async def spawn(self, config: RigConfig) -> int:
        """Start a process with `config`; returns its pid when it is ready. Raises `HostError`."""
        self._paths.notes.unlink(missing_ok=True)
        self._paths.config.write_bytes(configs.encode(config))
        paths = [*_ROOTS, *filter(None, [os.environ.get("PYTHONPATH")])]
        # One BLAS thread: its pool would be locked into memory, and nothing in the loop uses it.
        env = os.environ | {"PYTHONPATH": os.pathsep.join(paths), "OPENBLAS_NUM_THREADS": "1", "OMP_NUM_THREADS": "1"}
        child = self._child = self._started(env)
        self._ended = None
        deadline = time.monotonic() + START_S
        while time.monotonic() < deadline:
            if self.status(child) is not None:
                raise HostError(f"the rig process of {config.name} ended at once:\n{self._log_end()}")
            if self._paths.running() == child:
                return child
            await asyncio.sleep(0.02)
        os.kill(child, signal.SIGKILL)
        await self.reaped(child)
        raise HostError(f"the rig process of {config.name} was not ready within {START_S:g} s:\n{self._log_end()}")

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

    def _started(self, env: dict[str, str]) -> int:
        command = [sys.executable, "-m", "fullpose_server.runtime.loop.process", "--config", str(self._paths.config)]
        with self._paths.log.open("ab") as log, Path(os.devnull).open("rb") as nothing:
            return os.posix_spawn(
                sys.executable,
                command,
                env,
                file_actions=[
                    (os.POSIX_SPAWN_DUP2, nothing.fileno(), 0),
                    (os.POSIX_SPAWN_DUP2, log.fileno(), 1),
                    (os.POSIX_SPAWN_DUP2, log.fileno(), 2),
                ],
                setsid=True,  # a Ctrl-C at the server's terminal must not reach a moving rig
                setsigdef=[signal.SIGPIPE, signal.SIGXFSZ],  # which Python ignores, and an ignored signal is inherited
            )

    def _log_end(self) -> str:
        return self._paths.log.read_text("utf-8", "replace")[-2000:]
