"""The runner with real processes: whatever one job comes to, its end is told and the next one runs."""

import asyncio
import os
import signal
import sys
import threading
from collections.abc import Awaitable, Callable, Mapping
from typing import Any

from fullpose_server.errors import TransitionError
from fullpose_server.planning.job import Kind, Outcome
from fullpose_server.planning.runner import Runner, RunnerStatus
from fullpose_server.store.jobs import JobStatus
from tests.support.waiting import soon

# A worker that is told what to do: answer, go on for ever, or die.
PROGRAM = """
import json, os, sys, time
print(json.dumps({"ready": True}), flush=True)
for line in sys.stdin:
    wanted = json.loads(line)["request"]["do"]
    print(json.dumps({"progress": ["work", 1, 2]}), flush=True)
    if wanted == "die":
        os._exit(3)
    while wanted == "work":
        time.sleep(0.01)
    print(json.dumps({"failed": {"code": "x", "message": "y"}} if wanted == "fail" else {"done": {"n": 1}}), flush=True)
"""
WORKER = (sys.executable, "-c", PROGRAM)


class Made:
    """A job that keeps what it was told; its end waits for `may_write`, and may be refused."""

    kind = Kind.PLAN

    def __init__(self, name: str, do: str = "done", refusal: Exception | None = None) -> None:
        self.id = name
        self.outcomes: list[Outcome] = []
        self.writing, self.may_write, self.ended = threading.Event(), threading.Event(), asyncio.Event()
        self.beginning, self.may_begin, self.begun = threading.Event(), threading.Event(), False
        self.may_write.set()
        self.may_begin.set()
        self.finished_while_beginning = False
        self.already_ended = False
        self._do, self._refusal = do, refusal
        self._loop = asyncio.get_running_loop()

    def begin(self) -> Mapping[str, Any] | None:
        self.beginning.set()
        assert self.may_begin.wait(60.0)
        self.begun = True
        return None if self.already_ended else {"do": self._do}

    def finish(self, outcome: Outcome) -> None:
        self.writing.set()
        assert self.may_write.wait(60.0)
        self.finished_while_beginning = not self.begun
        if self.outcomes:
            raise TransitionError("it has ended")
        if self._refusal is None:
            self.outcomes.append(outcome)
        self._loop.call_soon_threadsafe(self.ended.set)
        if self._refusal is not None:
            raise self._refusal


def run(work: Callable[[Runner], Awaitable[None]], program: tuple[str, ...] = WORKER) -> None:
    async def inside() -> None:
        runner = Runner("test", prewarm=True, program=program)
        assert runner.status is RunnerStatus.STOPPED
        runner.start()
        try:
            await asyncio.wait_for(work(runner), 60.0)
        finally:
            await runner.close()
        assert runner.worker_pid is None

    asyncio.run(inside())


async def in_work(runner: Runner, job: Made) -> None:
    while (now := runner.progress(job.id)) is None or now.done == 0:  # noqa: ASYNC110 - it tells nobody
        await asyncio.sleep(0)


def test_a_cancel_while_the_end_is_written_changes_nothing_and_the_next_job_runs() -> None:
    """The worker was killed then, and every later plan failed on the dead one until the server was started again."""

    async def work(runner: Runner) -> None:
        first, second = Made("first"), Made("second")
        first.may_write.clear()
        runner.submit(first)
        await asyncio.to_thread(first.writing.wait, 60.0)
        cancel = asyncio.create_task(runner.cancel("first"))
        await asyncio.sleep(0)
        first.may_write.set()
        assert not await cancel, "it is done, not cancelled"
        runner.submit(second)
        await second.ended.wait()
        for job in (first, second):
            assert [outcome.status for outcome in job.outcomes] == [JobStatus.DONE]

    run(work)


def test_a_cancel_in_work_is_told_once_its_end_is_written() -> None:
    async def work(runner: Runner) -> None:
        endless, after = Made("endless", "work"), Made("after")
        runner.submit(endless)
        await in_work(runner, endless)
        assert await runner.cancel("endless")
        assert [outcome.status for outcome in endless.outcomes] == [JobStatus.CANCELLED]
        assert not await runner.cancel("endless")
        runner.submit(after)
        await after.ended.wait()
        assert after.outcomes[0].result == {"n": 1}

    run(work)


def test_an_end_that_cannot_be_written_does_not_end_the_runner() -> None:
    async def work(runner: Runner) -> None:
        unlucky, after = Made("unlucky", refusal=OSError("database is locked")), Made("after")
        runner.submit(unlucky)
        runner.submit(after)
        await after.ended.wait()
        assert after.outcomes[0].status is JobStatus.DONE
        assert runner.status is not RunnerStatus.STOPPED

    run(work)


async def ready(runner: Runner) -> int:
    """The worker's process, once it is there to be asked."""
    while runner.status is not RunnerStatus.IDLE or runner.worker_pid is None:  # noqa: ASYNC110 - it tells nobody
        await asyncio.sleep(0)
    return runner.worker_pid


def test_a_worker_that_dies_while_it_waits_is_told_and_replaced() -> None:
    """The planner was `starting` for good then, until a plan was asked for."""

    async def work(runner: Runner) -> None:
        first = await ready(runner)
        os.kill(first, signal.SIGKILL)
        while runner.status is RunnerStatus.IDLE:  # noqa: ASYNC110 - it tells nobody
            await asyncio.sleep(0)
        assert runner.status is RunnerStatus.RESTARTING
        assert await ready(runner) != first
        after = Made("after")
        runner.submit(after)
        await after.ended.wait()
        assert after.outcomes[0].status is JobStatus.DONE

    run(work)


def test_one_that_dies_again_and_again_is_left_to_the_next_job() -> None:
    async def work(runner: Runner) -> None:
        await soon(lambda: runner.status is RunnerStatus.RESTARTING)
        after = Made("after")
        runner.submit(after)
        await after.ended.wait()
        assert after.outcomes[0].status is JobStatus.FAILED
        assert runner.status is not RunnerStatus.STOPPED

    run(work, (sys.executable, "-c", 'import json; print(json.dumps({"ready": True}), flush=True)'))


def test_a_worker_that_dies_fails_its_job_and_is_replaced() -> None:
    async def work(runner: Runner) -> None:
        jobs = [Made("victim", "die"), Made("bad", "fail"), Made("after")]
        for job in jobs:
            runner.submit(job)
        await jobs[-1].ended.wait()
        victim, bad, after = (job.outcomes[0] for job in jobs)
        assert victim.error is not None
        assert "status 3" in victim.error["message"]
        assert bad.error == {"code": "x", "message": "y"}
        assert after.status is JobStatus.DONE

    run(work)


def test_a_worker_that_cannot_start_fails_every_job_and_says_so() -> None:
    """A comparison stayed "running" for ever."""

    async def work(runner: Runner) -> None:
        jobs = [Made("first"), Made("second")]
        for job in jobs:
            runner.submit(job)
        for job in jobs:
            await job.ended.wait()
            assert job.outcomes[0].status is JobStatus.FAILED
            assert job.outcomes[0].error is not None
            assert "did not start" in job.outcomes[0].error["message"]

    run(work, ("/nonexistent/python",))
    run(work, (sys.executable, "-c", "raise SystemExit(7)"))


def test_its_end_is_not_written_while_its_beginning_is() -> None:
    """Both write the same row: the database lets only one of them."""

    async def work(runner: Runner) -> None:
        job = Made("job")
        job.may_begin.clear()
        runner.submit(job)
        await asyncio.to_thread(job.beginning.wait, 60.0)
        closing = asyncio.create_task(runner.close())
        await asyncio.sleep(0)
        job.may_begin.set()
        await closing
        assert [outcome.status for outcome in job.outcomes] == [JobStatus.INTERRUPTED]
        assert not job.finished_while_beginning

    run(work)


def test_who_cancels_what_had_ended_before_it_was_begun_has_cancelled_nothing() -> None:
    async def work(runner: Runner) -> None:
        job = Made("job")
        job.already_ended = True
        job.may_begin.clear()
        runner.submit(job)
        await asyncio.to_thread(job.beginning.wait, 60.0)
        cancelling = asyncio.create_task(runner.cancel("job"))
        await asyncio.sleep(0)
        job.may_begin.set()
        assert not await cancelling
        assert job.outcomes == []

    run(work)


def test_who_closes_interrupts_the_job_in_work_and_leaves_the_queue() -> None:
    async def work(runner: Runner) -> None:
        endless, queued = Made("endless", "work"), Made("queued")
        runner.submit(endless)
        runner.submit(queued)
        await in_work(runner, endless)
        await runner.close()
        assert [outcome.status for outcome in endless.outcomes] == [JobStatus.INTERRUPTED]
        assert queued.outcomes == []

    run(work)
