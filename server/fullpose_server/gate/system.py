"""What a process that serves people asks of the system: to run before others, and as many files as it may have."""

import contextlib
import os
import resource

SERVER, GATE = 1, 2  # real-time priorities, of 99: both before all that is not real-time; a rig's loop has 60
MOST_FILES = 65536


def before_others(priority: int) -> None:
    """Run this thread before all that is not real-time, where the system lets us, and after the rigs' loops.

    What it starts, threads and processes, does not inherit it. A nice value would not do: Linux weighs it inside a
    session only.
    """
    with contextlib.suppress(PermissionError):
        os.sched_setscheduler(0, os.SCHED_RR | os.SCHED_RESET_ON_FORK, os.sched_param(priority))


def files() -> int:
    """Ask for as many files as this process may have open; returns what was granted."""
    soft, hard = resource.getrlimit(resource.RLIMIT_NOFILE)
    with contextlib.suppress(OSError, ValueError):
        resource.setrlimit(resource.RLIMIT_NOFILE, (min(hard, max(soft, MOST_FILES)), hard))
    return resource.getrlimit(resource.RLIMIT_NOFILE)[0]
