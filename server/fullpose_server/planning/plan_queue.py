"""Runs plans one after another in the planning process, with progress and cancel."""

import asyncio
import contextlib
import json
import logging
import sys
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Literal

from fullpose_server.errors import ServerError, TransitionError
from fullpose_server.planning.plan_request import PlanRequest
from fullpose_server.store.plans import PlanStore

log = logging.getLogger(__name__)
LINE = 64 * 1024 * 1024  # a report with a thousand violations is one line


@dataclass(frozen=True)
class Progress:
    """How far a job is."""

    phase: str
    done: int
    total: int


class PlannerError(ServerError):
    """The planning process cannot be had."""


class PlanQueue:
    """The jobs. `request` builds what the planning process is told from a plan's id, in a thread."""

    def __init__(self, plans: PlanStore, request: Callable[[str], PlanRequest]) -> None:
        self._plans = plans
        self._request = request
        self._waiting: asyncio.Queue[str] = asyncio.Queue()
        self._progress: dict[str, Progress] = {}
        self._running: str | None = None
        self._cancelled: set[str] = set()
        self._process: asyncio.subprocess.Process | None = None
        self._ready = False
        self._task: asyncio.Task[None] | None = None

    @property
    def status(self) -> Literal["idle", "busy", "starting", "stopped"]:
        """What the planning process does."""
        if self._task is None or self._task.done():
            return "stopped"
        if self._running is not None:
            return "busy"
        return "idle" if self._ready else "starting"

    def progress(self, plan: str) -> Progress | None:
        """Of a running plan."""
        return self._progress.get(plan)

    async def start(self) -> None:
        """Take up the queue where the last server left it."""
        for plan in await asyncio.to_thread(self._plans.after_restart):
            self._waiting.put_nowait(plan)
        self._task = asyncio.create_task(self._run(), name="plan queue")

    async def close(self) -> None:
        """End; the running plan is marked interrupted, the queued ones wait for the next server."""
        if self._task is not None:
            self._task.cancel()
            await asyncio.gather(self._task, return_exceptions=True)
        await self._kill()

    def submit(self, plan: str) -> None:
        """Queue a plan that is in the store."""
        self._waiting.put_nowait(plan)

    async def cancel(self, plan: str) -> None:
        """End a job. Raises `TransitionError` where there is nothing to cancel."""
        if self._running == plan:
            self._cancelled.add(plan)
            await self._kill()
            return
        await asyncio.to_thread(self._plans.finish, plan, "cancelled")

    async def _run(self) -> None:
        while True:
            if self._process is None:
                with contextlib.suppress(PlannerError):  # said again, by every plan that needs it
                    await self._spawn()
            plan = await self._waiting.get()
            row = await asyncio.to_thread(self._plans.begin, plan)
            if row is None:
                continue
            self._running = plan
            try:
                await self._one(plan)
            except asyncio.CancelledError:
                error = {"code": "interrupted", "message": "the server ended while this plan was being made"}
                with contextlib.suppress(TransitionError):  # it was just finished
                    self._plans.finish(plan, "interrupted", error=error)
                raise
            finally:
                self._running = None
                self._progress.pop(plan, None)
                self._cancelled.discard(plan)

    async def _one(self, plan: str) -> None:
        """Run one plan and write down how it ended."""
        try:
            request = await asyncio.to_thread(self._request, plan)
            answer = await self._ask(plan, request)
        except Exception as error:
            log.exception("plan %s", plan)
            answer = {"failed": {"code": "internal", "message": f"{type(error).__name__}: {error}"}}
        if plan in self._cancelled:
            await asyncio.to_thread(self._plans.finish, plan, "cancelled")
        elif "done" in answer:
            await asyncio.to_thread(self._plans.finish, plan, "done", result=answer["done"])
        else:
            await asyncio.to_thread(self._plans.finish, plan, "failed", error=answer["failed"])

    async def _ask(self, plan: str, request: PlanRequest) -> dict[str, Any]:
        process = self._process or await self._spawn()
        assert process.stdin is not None
        assert process.stdout is not None
        process.stdin.write(json.dumps(request.to_json()).encode() + b"\n")
        await process.stdin.drain()
        while line := await process.stdout.readline():
            message: dict[str, Any] = json.loads(line)
            if "progress" in message:
                self._progress[plan] = Progress(*message["progress"])
            else:
                return message
        self._process, self._ready = None, False
        code = await process.wait()
        ended = f"by signal {-code}" if code < 0 else f"with status {code}"
        return {"failed": {"code": "planner-ended", "message": f"the planning process ended {ended}, out of memory?"}}

    async def _spawn(self) -> asyncio.subprocess.Process:
        self._ready = False
        self._process = await asyncio.create_subprocess_exec(
            sys.executable,
            "-m",
            "fullpose_server.planning.plan_worker",
            stdin=asyncio.subprocess.PIPE,
            stdout=asyncio.subprocess.PIPE,
            limit=LINE,
            start_new_session=True,  # a terminal's Ctrl-C is for the server, which then ends this one
        )
        assert self._process.stdout is not None
        if not await self._process.stdout.readline():
            self._process = None
            raise PlannerError("the planning process did not start; the server's log says why")
        self._ready = True
        return self._process

    async def _kill(self) -> None:
        process = self._process
        if process is not None and process.returncode is None:
            process.kill()
            await process.wait()
