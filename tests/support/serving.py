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
NO_REAL_TIME = ("prlimit", "--rtprio=0:0")
if os.geteuid() == 0:
    NO_REAL_TIME += ("setpriv", "--bounding-set=-sys_nice", "--inh-caps=-sys_nice")


def few_files(files: int) -> tuple[str, ...]:
    """What starts a program that may have so many files open, and cannot ask for more."""
    return ("prlimit", f"--nofile={files}:{files}")


@contextmanager
def running(*arguments: str | Path, within: tuple[str, ...] = ()) -> Iterator[tuple["subprocess.Popen[str]", str]]:
    """A process of the command line and the address that it prints first."""
    process = start(*arguments, within=within)
    try:
        assert process.stdout is not None
        yield process, process.stdout.readline().strip()
    finally:
        if process.poll() is None:
            process.send_signal(signal.SIGINT)
        process.communicate(timeout=60)


def start(*arguments: str | Path, within: tuple[str, ...] = (), **env: str) -> "subprocess.Popen[str]":
    """Start one, by a program that takes rights or files away from it."""
    command = [*within, *COMMAND, *map(str, arguments)]
    return subprocess.Popen(
        command,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        env=os.environ | {"PYTHONPATH": PYTHONPATH} | env,
    )
