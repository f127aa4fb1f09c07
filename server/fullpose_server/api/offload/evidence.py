"""Evidence as the routes see it: made by a process of its own, one at a time, that is gone afterwards.

A record is read whole for it, which may take some hundred megabytes and seconds: neither is the server's.
"""

import asyncio
import json
import logging
import sys
from pathlib import Path
from typing import Any

from fullpose_server.api.problems import ApiError
from fullpose_server.api.schemas.base import Problem
from fullpose_server.location import Location, PostgresqlUrl
from fullpose_server.planning.worker_process import WorkerProcess

KIND = "evidence"
WAITING = 8  # beyond the one that is being made
_PROGRAM = (sys.executable, "-m", "fullpose_server.api.offload.evidence_worker")
log = logging.getLogger(__name__)


class EvidenceMaker:
    """Use it from one event loop. `folder` is the server's data folder, `database` has its rows."""

    def __init__(self, folder: Path, database: Location) -> None:
        self._folder = folder
        self._database = database
        self._turn = asyncio.Lock()
        self._asked = 0

    async def make(self, run: str, target: Path) -> None:
        """Write the bundle of a run. Raises `ApiError`; cancelled, it stops at once."""
        if self._asked > WAITING:
            raise ApiError(429, "busy", f"{self._asked} bundles are being made or asked for: try again")
        self._asked += 1
        try:
            async with self._turn:
                url = self._database.url if isinstance(self._database, PostgresqlUrl) else None
                await self._made({"folder": str(self._folder), "run": run, "target": str(target), "database": url})
        finally:
            self._asked -= 1

    async def _made(self, request: dict[str, Any]) -> None:
        worker = WorkerProcess(_PROGRAM)
        try:
            await worker.start()
            async for answer in worker.ask(json.dumps({"kind": KIND, "request": request})):
                match answer:
                    case {"done": _}:
                        return
                    case {"failed": {"unexpected": str(said)}}:
                        log.error("evidence of run %s: %s", request["run"], said)
                        raise ApiError(500, "internal", "an error of the server; its log tells more")
                    case {"failed": document}:
                        problem = Problem.model_validate(document)
                        code = problem.type.rpartition(":")[2]
                        raise ApiError(problem.status, code, problem.detail, errors=problem.errors)
            log.error("evidence of run %s: the process that makes it ended %s", request["run"], await worker.ended())
            raise ApiError(503, "worker", "the process that makes it has ended: there may be too little memory")
        except OSError as refusal:
            raise ApiError(503, "worker", f"the process that makes it did not start: {refusal}") from None
        finally:
            await worker.kill()
