"""One rig process in reserve: everything imported and every kernel loaded, it waits to be told whose it is.

Those are seconds that a rig whose process died would otherwise wait for. It belongs to the server: it ends when the
server does, and is a rig's from the moment that it is told.
"""

import asyncio
import contextlib
import logging
import os
import signal

from fullpose_server.runtime.contract.hung import suspended
from fullpose_server.runtime.contract.rig_paths import RigPaths
from fullpose_server.runtime.supervisor.spawn import spawned

AFTER_S = 5.0  # it is made when the rig that took the last one has long begun
_DOUBLINGS = 7  # of that, at most, where one after another ends by itself
log = logging.getLogger(__name__)


class Spare:
    """At most one, for all rigs of a server. Belongs to the event loop's thread."""

    def __init__(self) -> None:
        self._pid = 0
        self._pidfd = -1
        self._orders = -1  # the end of a pipe
        self._deaths = 0  # of those that ended by themselves, since one was taken
        self._making: asyncio.TimerHandle | None = None

    @property
    def pid(self) -> int:
        """Of the one that waits; 0: there is none."""
        return self._pid

    def make_soon(self) -> None:
        """Have one, in a while."""
        if self._making is None and not self._pid:
            after_s = AFTER_S * 2 ** min(self._deaths, _DOUBLINGS)
            self._making = asyncio.get_running_loop().call_later(after_s, self._make)

    def take(self, paths: RigPaths) -> int:
        """Make it the process of the rig whose configuration is written in `paths`: its pid; 0 where there is none."""
        pid, orders = self._let_go()
        self._deaths = 0
        if not pid:
            return 0
        try:
            if os.waitpid(pid, os.WNOHANG)[0]:
                log.warning("the rig process in reserve had ended")
                return 0
            if suspended(pid):
                log.warning("the rig process in reserve is suspended: it is ended")
                self._end(pid)
                return 0
            os.write(orders, f"{paths.config}\n".encode())
        except OSError as cause:
            log.warning("the rig process in reserve does not take its orders: %s", cause)
            self._end(pid)
            return 0
        finally:
            os.close(orders)
        return pid

    def close(self) -> None:
        """End it."""
        if self._making is not None:
            self._making.cancel()
        pid, orders = self._let_go()
        if pid:
            os.close(orders)
            self._end(pid)

    def _make(self) -> None:
        self._making = None
        theirs, orders = os.pipe2(os.O_CLOEXEC)
        try:
            self._pid = spawned(["--spare"], theirs, None)
        except OSError as cause:
            log.warning("no rig process in reserve: %s", cause)
            os.close(orders)
        else:
            self._orders, self._pidfd = orders, os.pidfd_open(self._pid)
            asyncio.get_running_loop().add_reader(self._pidfd, self._died)
        finally:
            os.close(theirs)

    def _died(self) -> None:
        """It has ended by itself, out of memory say: another is made."""
        pid, orders = self._let_go()
        os.close(orders)
        how = os.waitstatus_to_exitcode(os.waitpid(pid, 0)[1])
        log.warning("the rig process in reserve has ended (%d): another is made", how)
        self._deaths += 1
        self.make_soon()

    def _let_go(self) -> tuple[int, int]:
        """The one that waits, and the end of its pipe: they are the caller's from here on. 0: there is none."""
        pid, orders = self._pid, self._orders
        if pid:
            asyncio.get_running_loop().remove_reader(self._pidfd)
            os.close(self._pidfd)
        self._pid, self._pidfd, self._orders = 0, -1, -1
        return pid, orders

    @staticmethod
    def _end(pid: int) -> None:
        """It has begun nothing: nothing is lost."""
        with contextlib.suppress(ProcessLookupError, ChildProcessError):
            os.kill(pid, signal.SIGKILL)
            os.waitpid(pid, 0)
