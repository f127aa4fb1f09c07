"""The comparing process: one job, its folder as the argument. Progress goes to stdout, one JSON a line.

A process of its own, so that comparing takes neither the server's event loop nor its GIL, and cancelling is killing it.
"""

import json
import os
import sys
import threading
import time
from pathlib import Path
from typing import IO, Any

from fullpose.errors import SolverError
from fullpose_server.errors import ServerError, job_code
from fullpose_server.planning.comparisons import PAGE, REPORT, REQUEST, CompareRequest

REPORTS_S = 0.05  # shortest time between two reports of progress


def main() -> None:
    """Make the comparison; exit status 0 where it was made."""
    folder = Path(sys.argv[1])
    answers = os.fdopen(os.dup(1), "w", encoding="utf-8")
    os.dup2(2, 1)  # whatever prints must not write into the protocol
    os.nice(5)  # a rig's loop and the server come first
    threading.Thread(target=_end_with_the_server, daemon=True).start()
    try:
        _make(folder, answers)
    except (SolverError, ServerError) as error:
        _say(answers, {"failed": {"code": job_code(error), "message": str(error)}})
        sys.exit(1)


def _make(folder: Path, answers: IO[str]) -> None:
    import numpy as np

    from fullpose_server.formats.output_file import write_text
    from fullpose_server.planning.comparison import make_comparison
    from fullpose_server.store.trajectories import read_arrays

    request = CompareRequest.from_json((folder / REQUEST).read_text(encoding="utf-8"))
    at, q = read_arrays(Path(request.trajectory))
    order = {variant.label: k for k, variant in enumerate(request.methods)}
    due = 0.0

    def progress(label: str, done: int, total: int) -> None:
        nonlocal due
        if time.monotonic() >= due:
            due = time.monotonic() + REPORTS_S
            _say(answers, {"progress": [label, order[label] * total + done, len(order) * total]})

    start = None if request.start is None else np.array(request.start)
    made = make_comparison(
        request.name, np.array(at), np.array(q), request.rig, request.methods, start, request.rate_hz, progress
    )
    write_text(folder / PAGE, made.page)
    write_text(folder / REPORT, json.dumps(made.report))  # last: a folder with a report is done


def _end_with_the_server() -> None:
    sys.stdin.read()
    os._exit(1)


def _say(answers: IO[str], message: dict[str, Any]) -> None:
    answers.write(json.dumps(message) + "\n")
    answers.flush()


if __name__ == "__main__":
    main()
