"""Starting a rig process, and knowing how it ended."""

import asyncio
import os
import subprocess
import sys
import time
from pathlib import Path

import server
from server.runtime import config as configs
from server.runtime.config import RigConfig
from server.runtime.place import Place

START_S = 60.0  # with no kernel in the cache, compiling takes most of it
_ROOT = str(Path(server.__file__).resolve().parent.parent)


class HostError(Exception):
    """The rig process cannot be started or reached; the message holds the end of its log where there is one."""


class Launcher:
    """Starts the processes of one place, one after another."""

    def __init__(self, place: Place) -> None:
        self._place = place
        self._child: subprocess.Popen[bytes] | None = None

    async def spawn(self, config: RigConfig) -> int:
        """Start a process with `config`; returns its pid when it is ready. Raises `HostError`."""
        self._place.notes.unlink(missing_ok=True)
        self._place.config.write_bytes(configs.encode(config))
        paths = [_ROOT, *filter(None, [os.environ.get("PYTHONPATH")])]
        # One BLAS thread: its pool would be locked into memory, and nothing in the loop uses it.
        env = os.environ | {"PYTHONPATH": os.pathsep.join(paths), "OPENBLAS_NUM_THREADS": "1", "OMP_NUM_THREADS": "1"}
        with self._place.log.open("ab") as log:
            # A session of its own: a Ctrl-C at the server's terminal must not reach a moving rig.
            self._child = subprocess.Popen(  # noqa: ASYNC220
                [sys.executable, "-m", "server.runtime.process", "--config", str(self._place.config)],
                stdin=subprocess.DEVNULL,
                stdout=log,
                stderr=log,
                env=env,
                start_new_session=True,
            )
        deadline = time.monotonic() + START_S
        while time.monotonic() < deadline:
            if self._child.poll() is not None:
                raise HostError(f"the rig process of {config.name} ended at once:\n{self._log_end()}")
            if self._place.running() == self._child.pid:
                return self._child.pid
            await asyncio.sleep(0.02)
        self._child.kill()
        self._child.wait()
        raise HostError(f"the rig process of {config.name} was not ready within {START_S:g} s:\n{self._log_end()}")

    def status(self, pid: int) -> int | None:
        """How process `pid` ended (negative: by that signal); None while it lives, or where it is not ours to know."""
        if self._child is None or self._child.pid != pid:
            return None
        return self._child.poll()

    def _log_end(self) -> str:
        return self._place.log.read_text("utf-8", "replace")[-2000:]
