"""The processes that uploads are read and batches solved in, as the routes see them: asked, bounded, replaced.

Each takes one request after another. One that takes too long is killed, one that dies of what it was given is replaced:
the request is answered with a problem, the server and the other requests go on.
"""

import asyncio
import contextlib
import json
import logging
import sys
from collections.abc import Mapping
from typing import Any

from fullpose_server.api.offload.work import Work, memory_needed
from fullpose_server.api.problems import ApiError
from fullpose_server.api.schemas.base import Problem
from fullpose_server.planning.worker_process import WorkerProcess
from fullpose_server.settings import Settings

PROCESSES = 2
WAITING = 32  # requests, beyond those in work
PREWARM_S = 600.0  # that compiling may take on a fresh installation
_AFTER_PREWARM = frozenset({Work.DIAGNOSE, Work.PLANE, Work.TOLERANCE})  # wait until what they need is compiled
log = logging.getLogger(__name__)


class Offload:
    """Use it from one event loop."""

    def __init__(self, settings: Settings) -> None:
        self._memory = settings.max_upload_memory_bytes
        self._longest_s = settings.max_upload_s
        program = (sys.executable, "-m", "fullpose_server.api.offload.worker", str(self._memory))
        self._workers = [WorkerProcess(program) for _ in range(PROCESSES)]
        self._idle: asyncio.LifoQueue[WorkerProcess] = asyncio.LifoQueue()  # the one that was used last is taken first
        self._asked = 0
        self._prewarming: asyncio.Task[None] | None = None
        self._prewarms = (
            settings.spare_rig_process
        )  # as with the rig process in reserve: made ready before it is needed
        self._prewarmed = asyncio.Event()

    def start(self) -> None:
        """Have the processes ready before they are needed; who comes earlier waits for the first."""
        self._prewarming = asyncio.create_task(self._prewarm(), name="offload prewarm")

    async def close(self) -> None:
        """End the processes, whatever they do."""
        if self._prewarming is not None:
            self._prewarming.cancel()
            await asyncio.gather(self._prewarming, return_exceptions=True)
        for worker in self._workers:
            await worker.kill()

    async def run(self, work: Work, request: Mapping[str, Any]) -> Mapping[str, Any]:
        """What comes of it. Raises `ApiError`: what the request did wrong, 413, 422 and 429 for the bounds."""
        if self._asked >= PROCESSES + WAITING:
            raise ApiError(429, "busy", f"{self._asked} uploads and batches are being worked on: try again")
        self._asked += 1
        try:
            if work in _AFTER_PREWARM and self._prewarms:
                await self._prewarmed.wait()
            worker = await self._idle.get()
            try:
                return await self._answer(worker, work, request)
            finally:
                self._idle.put_nowait(worker)
        finally:
            self._asked -= 1

    async def _answer(self, worker: WorkerProcess, work: Work, request: Mapping[str, Any]) -> Mapping[str, Any]:
        try:
            async with asyncio.timeout(self._longest_s):
                return await self._told(worker, work, request)
        except TimeoutError:
            raise ApiError(422, "too-slow", f"it was not done within {self._longest_s:g} s: send less") from None

    async def _told(self, worker: WorkerProcess, work: Work, request: Mapping[str, Any]) -> Mapping[str, Any]:
        if not worker.ready:
            try:
                await worker.start()
            except OSError as refusal:
                raise ApiError(503, "worker", f"the process that does it did not start: {refusal}") from None
        finished = False
        try:
            async for answer in worker.ask(json.dumps({"kind": work, "request": request})):
                finished = True
                match answer:
                    case {"done": result}:
                        return dict(result)
                    case {"failed": {"unexpected": str(said)}}:
                        log.error("%s: %s", work, said)
                        raise ApiError(500, "internal", "an error of the server; its log tells more")
                    case {"failed": document}:
                        if document["type"].endswith(":memory"):
                            await worker.kill()  # what it has taken is not all given back
                        raise _refusal(Problem.model_validate(document))
                finished = False
            log.warning("%s: the process that did it ended %s", work, await worker.ended())
            raise memory_needed(self._memory)
        finally:
            if not finished:  # it is in the middle of something that nobody waits for any more
                await worker.kill()

    async def _prewarm(self) -> None:
        try:
            for worker in self._workers:  # one after another: the first is ready the sooner
                try:
                    with contextlib.suppress(OSError):  # said again, by the request that needs it
                        await worker.start()
                        if self._prewarms and worker is self._workers[-1]:
                            await self._compile(worker)
                finally:
                    self._idle.put_nowait(worker)
        finally:
            self._prewarmed.set()

    async def _compile(self, worker: WorkerProcess) -> None:
        """Have the kernels compiled, and kept for the other processes too, while those read uploads."""
        try:
            async with asyncio.timeout(PREWARM_S):
                await self._told(worker, Work.PREWARM, {})
        except (TimeoutError, ApiError) as error:  # a diagnosis then compiles them itself
            log.warning("what a diagnosis needs could not be compiled ahead: %r", error)
        await worker.kill()  # what it has loaded for that would count as an upload's
        await worker.start()


def _refusal(problem: Problem) -> ApiError:
    code = problem.type.rpartition(":")[2]
    return ApiError(problem.status, code, problem.detail, errors=problem.errors)
