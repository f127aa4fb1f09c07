"""A rig process as the system starts it: the very packages that run here, wherever they were found."""

import os
import signal
import sys
from pathlib import Path

import fullpose
import fullpose_server

PROGRAM = "fullpose_server.runtime.loop.process"
_ROOTS = [str(Path(*package.__path__).resolve().parent) for package in (fullpose_server, fullpose)]


def spawned(arguments: list[str], stdin: int, output: int | None) -> int:
    """Start a rig process; returns its pid. `output` is where it writes, None: where we do.

    Spawned, not a `Popen`: a rig process outlives the server that started it, by design, and a `Popen` that is dropped
    while its process runs takes that for a leak.
    """
    paths = [*_ROOTS, *filter(None, [os.environ.get("PYTHONPATH")])]
    # One BLAS thread: its pool would be locked into memory, and nothing in the loop uses it.
    env = os.environ | {"PYTHONPATH": os.pathsep.join(paths), "OPENBLAS_NUM_THREADS": "1", "OMP_NUM_THREADS": "1"}
    files: list[tuple[int, int, int]] = [(os.POSIX_SPAWN_DUP2, stdin, 0)]
    if output is not None:
        files += [(os.POSIX_SPAWN_DUP2, output, 1), (os.POSIX_SPAWN_DUP2, output, 2)]
    return os.posix_spawn(
        sys.executable,
        [sys.executable, "-m", PROGRAM, *arguments],
        env,
        file_actions=files,
        setsid=True,  # a Ctrl-C at the server's terminal must not reach a moving rig
        setsigdef=[signal.SIGPIPE, signal.SIGXFSZ],  # which Python ignores, and an ignored signal is inherited
    )
