"""A child that is suspended (SIGSTOP) is woken at once: whoever asks it waits meanwhile."""

import contextlib
import logging
import os
import signal
import threading

log = logging.getLogger(__name__)


def keep_awake(pid: int, what: str) -> threading.Thread:
    """Watch child `pid`, called `what` in the log, for as long as it lives; it stays its starter's to reap.

    The kernel tells when it is suspended. It is watched in a thread of its own, which waits in the kernel alone: the
    event loop may be what somebody keeps busy, and a look now and then would come late.
    """
    watching = threading.Thread(target=_watch, args=(os.pidfd_open(pid), pid, what), name=f"wake {what}", daemon=True)
    watching.start()
    return watching


def _watch(pidfd: int, pid: int, what: str) -> None:
    try:
        with contextlib.suppress(ChildProcessError, ProcessLookupError):  # it was reaped: it has ended
            while True:
                found = os.waitid(os.P_PIDFD, pidfd, os.WSTOPPED | os.WEXITED | os.WNOWAIT)
                if found is None or found.si_code != os.CLD_STOPPED:
                    return
                signal.pidfd_send_signal(pidfd, signal.SIGCONT)
                log.warning("%s, process %d, was suspended: it is woken", what, pid)
    finally:
        os.close(pidfd)
