"""Plans as jobs in the real planning process: done, failed, cancelled, interrupted, and after a crash."""

import asyncio
import os
import signal
from collections.abc import Awaitable, Callable

import numpy as np
import pytest

from fullpose_server.errors import TransitionError
from fullpose_server.formats.plan_folder import read_plan
from fullpose_server.planning.plan_queue import PlanQueue
from fullpose_server.store.jobs import JobStatus
from tests.support.stores import Stores
from tests.support.waiting import until

SLOW = "time_s,yaw_deg,pitch_deg,roll_deg\n" + "".join(
    f"{k / 10},{20 * np.sin(k / 20)},{10 * np.sin(k / 30)},{5 * np.sin(k / 25)}\n" for k in range(301)
)


def run(stores: Stores, work: Callable[[PlanQueue], Awaitable[None]]) -> None:
    async def inside() -> None:
        queue = PlanQueue(stores.plans, stores.request)
        await queue.start()
        try:
            await work(queue)
        finally:
            await queue.close()

    asyncio.run(inside())


async def ended(stores: Stores, plan: str) -> str:
    def status() -> str | None:
        now = JobStatus(stores.plans.get(plan).status)
        return now.value if now.finished else None

    return await asyncio.to_thread(until, status)


async def begun(queue: PlanQueue, plan: str) -> None:
    await asyncio.to_thread(until, lambda: queue.progress(plan), every_s=0.001)


def _phase(queue: PlanQueue, plan: str) -> str | None:
    progress = queue.progress(plan)
    return None if progress is None else progress.phase


def test_a_plan_is_made_with_leads_and_report(stores: Stores) -> None:
    plan = stores.add_plan(stores.add_flight(SLOW))

    async def work(queue: PlanQueue) -> None:
        queue.submit(plan)
        assert await ended(stores, plan) == "done"

    run(stores, work)
    result = stores.plans.get(plan).result
    assert result is not None
    assert result["feasible"], result["refusal"]
    assert result["refusal"] is None
    assert result["report"]["max_matrix_error"] <= 1e-14
    folder = read_plan(stores.plans.folder(plan))
    assert folder.info.plan_hash == result["plan_hash"]
    assert folder.info.lead_in_samples > 0
    # The whole path, leads included, starts and ends at rest.
    steps = np.abs(np.diff(folder.angles, axis=0))
    assert steps[0].max() <= 5e-3 * steps.max()
    assert steps[-1].max() <= 5e-3 * steps.max()


def test_a_flight_that_is_no_flight_fails_with_a_reason_and_the_next_one_goes_on(stores: Stores) -> None:
    endless = stores.add_plan(stores.add_flight("time_s,yaw_deg,pitch_deg,roll_deg\n0,1,2,3\n1e9,2,3,4\n"))
    good = stores.add_plan(stores.add_flight(SLOW))

    async def work(queue: PlanQueue) -> None:
        queue.submit(endless)
        queue.submit(good)
        assert await ended(stores, endless) == "failed"
        assert await ended(stores, good) == "done"

    run(stores, work)
    error = stores.plans.get(endless).error
    assert error is not None
    assert "duration_s" in error["message"]


@pytest.mark.parametrize("method", ["exact", "plan", "preview"])
@pytest.mark.parametrize("rows", ["0,10,20,30\n", "0,10,20,30\n0.001,10,20,30\n"])
def test_a_flight_of_a_moment_is_planned_as_a_stand(stores: Stores, method: str, rows: str) -> None:
    plan = stores.add_plan(stores.add_flight("time_s,yaw_deg,pitch_deg,roll_deg\n" + rows), method)

    async def work(queue: PlanQueue) -> None:
        queue.submit(plan)
        assert await ended(stores, plan) == "done"

    run(stores, work)
    result = stores.plans.get(plan).result
    assert result is not None
    assert result["refusal"] is None
    assert "held" in result["resampling"]
    folder = read_plan(stores.plans.folder(plan))
    assert result["samples"] == 2 + folder.info.lead_in_samples + folder.info.lead_out_samples
    np.testing.assert_allclose(folder.angles, np.tile(folder.angles[0], (len(folder.angles), 1)), atol=1e-3)
    assert np.nanmax(np.rad2deg(folder.error)) < 1e-11


def test_cancel_works_at_any_moment_and_leaves_nothing(stores: Stores) -> None:
    flight = stores.add_flight(SLOW)
    running, queued, after = (stores.add_plan(flight, rate_hz=rate) for rate in (4000.0, 200.0, 200.0))

    async def work(queue: PlanQueue) -> None:
        for plan in (running, queued, after):
            queue.submit(plan)
        await begun(queue, running)
        await queue.cancel(queued)
        await queue.cancel(running)
        assert await ended(stores, running) == "cancelled"
        assert await ended(stores, queued) == "cancelled"
        assert await ended(stores, after) == "done"
        with pytest.raises(TransitionError):
            await queue.cancel(after)

    run(stores, work)
    assert not stores.plans.folder(running).exists()
    assert not stores.plans.folder(queued).exists()


def test_a_planning_process_that_dies_fails_its_plan_and_is_replaced(stores: Stores) -> None:
    flight = stores.add_flight(SLOW)
    victim, after = stores.add_plan(flight, rate_hz=4000.0), stores.add_plan(flight)

    async def work(queue: PlanQueue) -> None:
        queue.submit(victim)
        queue.submit(after)
        # Its process works at it: one that died before it was asked is replaced, and the plan made.
        await asyncio.to_thread(until, lambda: _phase(queue, victim) not in (None, "starting"), every_s=0.001)
        assert queue.worker_pid is not None
        os.kill(queue.worker_pid, signal.SIGKILL)
        assert await ended(stores, victim) == "failed"
        assert await ended(stores, after) == "done"

    run(stores, work)
    error = stores.plans.get(victim).error
    assert error is not None
    assert "signal 9" in error["message"]


def test_a_server_that_ends_interrupts_its_plan_and_the_next_one_takes_up_the_queue(stores: Stores) -> None:
    flight = stores.add_flight(SLOW)
    running, queued = stores.add_plan(flight, rate_hz=4000.0), stores.add_plan(flight)

    async def work(queue: PlanQueue) -> None:
        queue.submit(running)
        queue.submit(queued)
        await begun(queue, running)

    run(stores, work)
    assert stores.plans.get(running).status == "interrupted"
    assert stores.plans.get(queued).status == "queued"

    async def next_server(queue: PlanQueue) -> None:
        assert await ended(stores, queued) == "done"

    run(stores, next_server)


def test_a_plan_found_running_at_start_was_interrupted(stores: Stores) -> None:
    plan = stores.add_plan(stores.add_flight(SLOW))
    assert stores.plans.begin(plan) is not None  # and then the server was killed
    draft = stores.plans.root / f".{plan}.x"
    draft.mkdir()
    assert stores.plans.after_restart() == []
    assert stores.plans.get(plan).status == "interrupted"
    assert not draft.exists()
