"""What holds for every process of ours: how long it may take to begin, and what can be said of its end."""

import contextlib
import ctypes
import os
import signal
from pathlib import Path

# To begin: a starved machine takes long over the imports, and with no kernel in the cache compiling takes most of it.
START_S = 180.0
_COUNTERS = Path("/proc/vmstat")


def call_itself(title: str) -> None:
    """Have `ps` show this for the calling process, in place of the command line that it was started by.

    Where the kernel keeps that line is in /proc/self/stat (proc(5), arg_start and arg_end); a longer title is cut off.
    """
    with contextlib.suppress(OSError, ValueError, IndexError):
        fields = Path("/proc/self/stat").read_text("ascii", "replace").rsplit(")", 1)[1].split()
        begin, end = int(fields[45]), int(fields[46])
        if 0 < begin < end:
            ctypes.memmove(begin, title.encode()[: end - begin - 1].ljust(end - begin, b"\0"), end - begin)


def after_others(niceness: int) -> None:
    """Have the calling process wait for the processor where the server or another program wants it.

    A nice value alone says that to the processes of the same session. One that leads a session of its own is weighed as
    a group against the others' (sched(7), autogroup): there the group is what has to be nice.
    """
    os.nice(niceness)
    if os.getsid(0) == os.getpid():
        with contextlib.suppress(OSError):  # a kernel without groups, or a container that may not write there
            Path("/proc/self/autogroup").write_text(str(niceness), "ascii")


def memory_kills(counters: Path = _COUNTERS) -> int:
    """How many processes the system has killed for lack of memory, control groups' too; 0 where it does not say."""
    try:
        lines = counters.read_text("ascii").splitlines()
    except OSError:
        return 0
    return next((int(line.split()[1]) for line in lines if line.startswith("oom_kill ")), 0)


def how_it_ended(code: int, kills_before: int, kills: int) -> str:
    """In words, by its exit status (negative: a signal) and the `memory_kills` before it began and now.

    A process that is killed for lack of memory cannot tell: its end is a plain SIGKILL.
    """
    if code >= 0:
        return f"exit status {code}"
    starved = code == -signal.SIGKILL and kills > kills_before
    return f"signal {-code}" + (", and the system has killed for lack of memory meanwhile" if starved else "")
