"""What a server does for its store by itself: once after its start, and every so often."""

import asyncio
import logging
from collections.abc import Callable
from typing import Any

EVERY_S = 60.0
log = logging.getLogger(__name__)


class Upkeep:
    """One task. `once` after the start, in a thread; then `often` every minute, where there is such."""

    def __init__(self, once: Callable[[], Any], often: Callable[[], Any] | None) -> None:
        self._once = once
        self._often = often
        self._task: asyncio.Task[None] | None = None
        self._fault: str | None = None

    def start(self) -> None:
        """Begin."""
        self._task = asyncio.create_task(self._run(), name="upkeep")

    async def close(self) -> None:
        """End; what is in work comes to its end."""
        if self._task is not None:
            self._task.cancel()
            await asyncio.gather(self._task, return_exceptions=True)

    def findings(self) -> list[str]:
        """What went wrong with it last, in words."""
        return [] if self._fault is None else [f"upkeep of the store: {self._fault}"]

    async def _run(self) -> None:
        await self._do(self._once)
        while self._often is not None:
            await self._do(self._often)
            await asyncio.sleep(EVERY_S)

    async def _do(self, work: Callable[[], Any]) -> None:
        try:
            await _to_its_end(work)
        except Exception as fault:
            log.exception("upkeep of the store")
            self._fault = f"{type(fault).__name__}: {fault}"
        else:
            self._fault = None


async def _to_its_end(work: Callable[[], Any]) -> None:
    """In a thread; who cancels waits for it: it has the database."""
    running = asyncio.ensure_future(asyncio.to_thread(work))
    try:
        await asyncio.shield(running)
    except asyncio.CancelledError:
        await asyncio.wait([running])
        raise
