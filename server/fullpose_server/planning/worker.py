"""The worker process: makes plans and comparisons.

It reads requests from stdin, one JSON a line, and answers on stdout likewise.

A process of its own, so that the numerics take neither the server's event loop nor its GIL, and so that cancelling is
killing it, which works at any moment. It ends when its stdin does, so it never outlives the server.
"""

import json
import os
import queue
import sys
import threading
import time
from collections.abc import Callable, Mapping
from typing import IO, Any

from fullpose.errors import SolverError
from fullpose_server.errors import ServerError, job_code
from fullpose_server.planning.job import Kind
from fullpose_server.processes import after_others

Progress = Callable[[str, int, int], None]  # phase, done, total
Maker = Callable[[Any, Progress], Mapping[str, Any]]

REPORTS_S = 0.05  # shortest time between two reports of progress


def main() -> None:
    """Make plans and comparisons until stdin ends."""
    serve(_makers, _failure)


def _makers() -> Mapping[str, Maker]:
    # Numba and SciPy: a second that start-up hides.
    from fullpose_server.planning.make_comparison import make_comparison_folder
    from fullpose_server.planning.make_plan import make_plan_folder

    return {Kind.PLAN: make_plan_folder, Kind.COMPARISON: make_comparison_folder}


def _failure(error: Exception) -> dict[str, Any]:
    if isinstance(error, (SolverError, ServerError)):
        return {"code": job_code(error), "message": str(error)}
    return {"code": "internal", "message": f"{type(error).__name__}: {error}"}  # the server logs it


def serve(
    load: Callable[[], Mapping[str, Maker]], failure: Callable[[Exception], dict[str, Any]], niceness: int = 10
) -> None:
    """Answer requests until stdin ends: each by the maker of its kind, or by what its failure is in words."""
    answers = os.fdopen(os.dup(1), "w", encoding="utf-8")
    os.dup2(2, 1)  # whatever prints must not write into the protocol
    after_others(niceness)  # a rig's loop and the server come first
    makers = load()
    _say(answers, {"ready": True})
    for line in iter(_requests().get, None):
        message = json.loads(line)
        reporter = _Reporter(answers)
        try:
            result = makers[message["kind"]](message["request"], reporter.report)
        except Exception as error:  # noqa: BLE001 - the job failed, the process goes on
            _say(answers, {"failed": failure(error)})
        else:
            _say(answers, {"done": result})


def _requests() -> "queue.SimpleQueue[str]":
    """Lines of stdin as they come; the process ends with it, in the middle of a job too."""
    lines: queue.SimpleQueue[str] = queue.SimpleQueue()

    def read() -> None:
        for line in sys.stdin:
            lines.put(line)
        os._exit(0)

    threading.Thread(target=read, daemon=True).start()
    return lines


class _Reporter:
    def __init__(self, answers: IO[str]) -> None:
        self._answers = answers
        self._phase = ""
        self._next = 0.0

    def report(self, phase: str, done: int, total: int) -> None:
        now = time.monotonic()
        if phase != self._phase or now >= self._next:
            self._phase, self._next = phase, now + REPORTS_S
            _say(self._answers, {"progress": [phase, done, total]})


def _say(answers: IO[str], message: Mapping[str, Any]) -> None:
    answers.write(json.dumps(message) + "\n")
    answers.flush()


if __name__ == "__main__":
    main()
