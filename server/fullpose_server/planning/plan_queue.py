"""Plans as jobs: their rows in the store, made one after another by a runner."""

import asyncio
from collections.abc import Callable, Mapping
from typing import Any

from fullpose_server.planning.job import Kind, Outcome, Progress
from fullpose_server.planning.plan_request import PlanRequest
from fullpose_server.planning.runner import Pending, Runner, RunnerStatus
from fullpose_server.store.jobs import JobStatus
from fullpose_server.store.plans import PlanStore


class PlanJob:
    """One plan as a `Job`; `request` builds what the worker is told from the plan's id."""

    kind = Kind.PLAN

    def __init__(self, plan: str, plans: PlanStore, request: Callable[[str], PlanRequest]) -> None:
        self.id = plan
        self._plans = plans
        self._request = request

    def begin(self) -> Mapping[str, Any] | None:
        """Its row is marked running."""
        return None if self._plans.begin(self.id) is None else self._request(self.id).to_json()

    def finish(self, outcome: Outcome) -> None:
        """How it ended goes into its row. Raises `TransitionError`."""
        result = None if outcome.result is None else dict(outcome.result)
        error = None if outcome.error is None or outcome.status is JobStatus.CANCELLED else dict(outcome.error)
        self._plans.finish(self.id, outcome.status, result=result, error=error)


class PlanQueue:
    """The plans to be made, remedies among them."""

    def __init__(self, plans: PlanStore, request: Callable[[str], PlanRequest]) -> None:
        self._plans = plans
        self._request = request
        self._runner = Runner("plans", prewarm=True)

    @property
    def status(self) -> RunnerStatus:
        """What the planning process does."""
        return self._runner.status

    @property
    def worker_pid(self) -> int | None:
        """Of the planning process, where there is one."""
        return self._runner.worker_pid

    def progress(self, plan: str) -> Progress | None:
        """Of a running plan."""
        return self._runner.progress(plan)

    async def start(self) -> None:
        """Take up the queue where the last server left it."""
        for plan in await asyncio.to_thread(self._plans.after_restart):
            self.submit(plan)
        self._runner.start()

    async def close(self) -> None:
        """End; the running plan is marked interrupted, the queued ones wait for the next server."""
        await self._runner.close()

    @property
    def pending(self) -> Pending:
        """What waits or is in work."""
        return self._runner.pending

    def submit(self, plan: str, owner: str = "") -> None:
        """Queue a plan that is in the store; `owner` is who asked for it."""
        self._runner.submit(PlanJob(plan, self._plans, self._request), owner)

    async def cancel(self, plan: str) -> None:
        """End a job. Raises `TransitionError` where there is nothing to cancel."""
        if not await self._runner.cancel(plan):
            await asyncio.to_thread(self._plans.finish, plan, JobStatus.CANCELLED)
            self._runner.pending.remove(plan)
