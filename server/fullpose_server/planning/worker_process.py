"""The worker process as its runner sees it: started, asked, killed. One JSON document a line, both ways."""

import asyncio
import json
from collections.abc import AsyncIterator
from typing import Any

from fullpose_server.processes import how_it_ended, memory_kills

LINE = 64 * 1024 * 1024  # a report with a thousand violations is one line


class WorkerProcess:
    """At most one process at a time. A process of its own, so that cancelling is killing, which always works."""

    def __init__(self, program: tuple[str, ...]) -> None:
        self._program = program
        self._process: asyncio.subprocess.Process | None = None
        self._ready = False
        self._memory_kills = 0  # of the system, before it began

    @property
    def ready(self) -> bool:
        """Whether it is there to be asked."""
        return self._ready and self._process is not None and self._process.returncode is None

    @property
    def pid(self) -> int | None:
        """Its process id, where there is one."""
        return None if self._process is None or self._process.returncode is not None else self._process.pid

    async def start(self) -> None:
        """Start it and wait until it is ready. Raises `OSError` where it does not come to that."""
        await self.kill()
        self._memory_kills = memory_kills()
        self._process = await asyncio.create_subprocess_exec(
            *self._program,
            stdin=asyncio.subprocess.PIPE,  # it ends when this does, so it never outlives the server
            stdout=asyncio.subprocess.PIPE,
            limit=LINE,
            start_new_session=True,  # a terminal's Ctrl-C is for the server, which then ends this one
        )
        self._ready = bool(await self._line())
        if not self._ready:
            raise OSError(f"it ended {await self.ended()}")

    async def ask(self, request: str) -> AsyncIterator[Any]:
        """Its answers to a request (one line of JSON), until it ends; who has the last one stops asking."""
        process = self._process
        if process is None or process.stdin is None:
            return
        try:
            process.stdin.write(request.encode() + b"\n")
            await process.stdin.drain()
        except ConnectionError:  # it is gone: there are no answers
            return
        while line := await self._line():
            yield json.loads(line)

    async def kill(self) -> None:
        """End it, whatever it does."""
        process = self._process
        self._ready = False
        if process is not None and process.returncode is None:
            process.kill()
            await process.wait()

    async def ended(self) -> str:
        """How it ended, in words, once it has."""
        if self._process is None:
            return "before it began"
        code = await self._process.wait()
        return f"by {how_it_ended(code, self._memory_kills, memory_kills())}"

    async def _line(self) -> bytes:
        if self._process is None or self._process.stdout is None:
            return b""
        return await self._process.stdout.readline()
