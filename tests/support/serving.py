"""The command line's servers as processes, as a user starts them."""

import os
import signal
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from tests.support.repository import PYTHONPATH

COMMAND = (sys.executable, "-c", "from fullpose_server.cli import main; main()")


@contextmanager
def running(*arguments: str | Path, files: int | None = None) -> Iterator[tuple["subprocess.Popen[str]", str]]:
    """A process of the command line and the address that it prints first."""
    process = start(*arguments, files=files)
    try:
        assert process.stdout is not None
        yield process, process.stdout.readline().strip()
    finally:
        if process.poll() is None:
            process.send_signal(signal.SIGINT)
        process.communicate(timeout=60)


def start(*arguments: str | Path, files: int | None = None, **env: str) -> "subprocess.Popen[str]":
    """Start one; with `files` it may have no more of them open, and cannot ask for more."""
    limited = [] if files is None else ["prlimit", f"--nofile={files}:{files}"]
    command = [*limited, *COMMAND, *map(str, arguments)]
    return subprocess.Popen(
        command,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        env=os.environ | {"PYTHONPATH": PYTHONPATH} | env,
    )
