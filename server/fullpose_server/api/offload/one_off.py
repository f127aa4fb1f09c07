"""Work of a process of its own that is gone afterwards: what it takes of memory and time is not the server's."""

import json
import logging
import sys
from collections.abc import Callable, Mapping
from typing import Any

from fullpose_server.api.problems import ApiError
from fullpose_server.api.schemas.base import Problem
from fullpose_server.planning.worker_process import WorkerProcess

log = logging.getLogger(__name__)


async def done_apart(
    module: str, kind: str, request: Mapping[str, Any], progress: Callable[[float], None] | None = None
) -> None:
    """Have `module` do what is asked, and tell how far it is. Raises `ApiError`; cancelled, it stops at once."""
    worker = WorkerProcess((sys.executable, "-m", module))
    try:
        await worker.start()
        async for answer in worker.ask(json.dumps({"kind": kind, "request": request})):
            match answer:
                case {"progress": [_, int(done), int(total)]}:
                    if progress is not None:
                        progress(done / total)
                case {"done": _}:
                    return
                case {"failed": {"unexpected": str(said)}}:
                    log.error("%s: %s", kind, said)
                    raise ApiError(500, "internal", "an error of the server; its log tells more")
                case {"failed": document}:
                    problem = Problem.model_validate(document)
                    code = problem.type.rpartition(":")[2]
                    raise ApiError(problem.status, code, problem.detail, errors=problem.errors)
        log.error("%s: the process that makes it ended %s", kind, await worker.ended())
        raise ApiError(503, "worker", "the process that makes it has ended: there may be too little memory")
    except OSError as refusal:
        raise ApiError(503, "worker", f"the process that makes it did not start: {refusal}") from None
    finally:
        await worker.kill()
