"""Runs jobs one after another in a worker process, with progress and cancel."""

import asyncio
import contextlib
import json
import logging
import sys
from collections.abc import Callable, Mapping
from enum import StrEnum
from typing import Any, TypeVar

from fullpose_server.errors import TransitionError
from fullpose_server.planning.job import Job, Outcome, Progress, failed
from fullpose_server.planning.worker_process import WorkerProcess
from fullpose_server.store.jobs import JobStatus

log = logging.getLogger(__name__)
Result = TypeVar("Result")
_REPLACED = 3  # times that a worker which ends by itself is, before a job comes; then the job must need it


class RunnerStatus(StrEnum):
    """What a runner does."""

    STARTING = "starting"
    RESTARTING = "restarting"  # its process has ended by itself; jobs wait for the next one
    IDLE = "idle"
    BUSY = "busy"
    STOPPED = "stopped"


class Pending:
    """The jobs that wait or are in work, and who asked for each; "" for those of an earlier server."""

    def __init__(self) -> None:
        self._owners: dict[str, str] = {}

    @property
    def total(self) -> int:
        """Of all."""
        return len(self._owners)

    def of(self, owner: str) -> int:
        """Of one who asked."""
        return sum(other == owner for other in self._owners.values())

    def add(self, job: str, owner: str) -> None:
        """One more."""
        self._owners[job] = owner

    def remove(self, job: str) -> None:
        """It has ended, in whatever way."""
        self._owners.pop(job, None)


class _Running:
    """The job in work: whether the worker still has it, whether it was cancelled, and when its end is written."""

    def __init__(self, job: Job) -> None:
        self.job = job
        self.progress = Progress("starting", 0, 1)
        self.answered = False
        self.cancelled = False
        self.written = asyncio.Event()


class Runner:
    """One queue of jobs and one worker process. Use it from one event loop.

    prewarm: the worker is there before the first job, and stays; otherwise it lives as long as a job. Whatever a job
    comes to, the next one runs: a worker that died is replaced, and an end that cannot be written down is logged.
    """

    def __init__(self, name: str, *, prewarm: bool, program: tuple[str, ...] | None = None) -> None:
        self._name = name
        self._prewarm = prewarm
        self._waiting: asyncio.Queue[Job] = asyncio.Queue()
        self.pending = Pending()
        self._running: _Running | None = None
        self._worker = WorkerProcess(program or (sys.executable, "-m", "fullpose_server.planning.worker"))
        self._task: asyncio.Task[None] | None = None
        self._to_begin = True  # the worker: not begun yet, or killed by us

    @property
    def status(self) -> RunnerStatus:
        """What it does; `stopped` where nothing will be run any more."""
        if self._task is None or self._task.done():
            return RunnerStatus.STOPPED
        if self._running is not None:
            return RunnerStatus.BUSY
        if self._worker.ready or not self._prewarm:
            return RunnerStatus.IDLE
        return RunnerStatus.STARTING if self._to_begin else RunnerStatus.RESTARTING

    @property
    def worker_pid(self) -> int | None:
        """Of the worker process, where there is one."""
        return self._worker.pid

    def progress(self, job: str) -> Progress | None:
        """Of the job in work; None for any other."""
        return self._running.progress if self._running is not None and self._running.job.id == job else None

    def start(self) -> None:
        """Begin to take jobs."""
        self._task = asyncio.create_task(self._run(), name=f"{self._name} runner")

    def submit(self, job: Job, owner: str = "") -> None:
        """Queue a job; `owner` is who asked for it."""
        self.pending.add(job.id, owner)
        self._waiting.put_nowait(job)

    async def cancel(self, job: str) -> bool:
        """End a job in work, and wait until its end is written; False where it is not in work."""
        running = self._running
        if running is None or running.job.id != job:
            return False
        if not running.answered:  # the worker has it: what is answered already is done, and stays so
            running.cancelled = self._to_begin = True
            await self._worker.kill()
        await running.written.wait()
        return running.cancelled

    async def close(self) -> None:
        """End; the job in work is marked interrupted, the queued ones are left as they are."""
        if self._task is not None:
            self._task.cancel()
            await asyncio.gather(self._task, return_exceptions=True)
        await self._worker.kill()

    async def _run(self) -> None:
        while True:
            job = await self._next()
            running = self._running = _Running(job)
            try:
                await self._write(job, await self._outcome(running))
            except asyncio.CancelledError:
                error = {"code": "interrupted", "message": f"the server ended while this {job.kind} was being made"}
                await self._write(job, Outcome(JobStatus.INTERRUPTED, error=error))
                raise
            finally:
                self._running = None
                self.pending.remove(job.id)
                running.written.set()
            if not self._prewarm:
                await self._worker.kill()

    async def _next(self) -> Job:
        """The next job. Until it comes a prewarmed worker is there: one that ends is replaced."""
        waiting = asyncio.ensure_future(self._waiting.get())
        try:
            for _ in range(1 + _REPLACED if self._prewarm else 0):
                if not self._worker.ready:
                    with contextlib.suppress(OSError):  # said again, by every job that needs it
                        await self._worker.start()
                if not self._worker.ready:
                    break
                self._to_begin = False
                ended = asyncio.ensure_future(self._worker.ended())
                await asyncio.wait((waiting, ended), return_when=asyncio.FIRST_COMPLETED)
                if waiting.done():
                    ended.cancel()
                    break
                log.error("%s: its process ended %s while it waited; another is started", self._name, ended.result())
            return await waiting
        finally:
            waiting.cancel()

    async def _outcome(self, running: _Running) -> Outcome | None:
        job = running.job
        try:
            request = await _to_its_end(job.begin)
            if request is None:  # it had ended while it waited: who cancels it meanwhile has cancelled nothing
                running.cancelled = False
                return None
            outcome = await self._made(running, {"kind": job.kind, "request": request})
        except Exception as fault:
            log.exception("%s %s", job.kind, job.id)
            return failed("internal", f"{type(fault).__name__}: {fault}")
        if running.cancelled:
            error = {"code": "cancelled", "message": "cancelled before it was done"}
            return Outcome(JobStatus.CANCELLED, error=error)
        if outcome.error is not None:
            log.warning("%s %s: %s", job.kind, job.id, outcome.error["message"])
        return outcome

    async def _made(self, running: _Running, message: Mapping[str, Any]) -> Outcome:
        """What the worker makes of it, or how it ended."""
        if running.cancelled:  # no worker need be started for it
            return failed("cancelled", "before it began")
        if not self._worker.ready:
            try:
                await self._worker.start()
            except OSError as refusal:
                return failed(
                    "worker", f"the process that makes it did not start: {refusal}; the server's log says why"
                )
            self._to_begin = False
        async for answer in self._worker.ask(json.dumps(message)):
            match answer:
                case {"progress": [str(phase), int(done), int(total)]}:
                    running.progress = Progress(phase, done, total)
                case {"done": result}:
                    running.answered = True
                    return Outcome(JobStatus.DONE, result=result)
                case {"failed": error}:
                    running.answered = True
                    return Outcome(JobStatus.FAILED, error=error)
        return failed("worker-ended", f"the process that made it ended {await self._worker.ended()}, out of memory?")

    async def _write(self, job: Job, outcome: Outcome | None) -> None:
        if outcome is None:
            return
        try:
            await _to_its_end(job.finish, outcome)
        except TransitionError:
            pass  # it was written before
        except Exception:
            log.exception("the end of %s %s could not be written down", job.kind, job.id)


async def _to_its_end(work: Callable[..., Result], *arguments: Any) -> Result:
    """In a thread, and to its end where the server ends meanwhile: two writes of one row never run side by side."""
    running = asyncio.ensure_future(asyncio.to_thread(work, *arguments))
    try:
        return await asyncio.shield(running)
    except asyncio.CancelledError:
        await asyncio.wait([running])
        raise
