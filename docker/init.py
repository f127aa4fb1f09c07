"""The container's first process: starts the server, and keeps the rigs' processes alive when the server dies.

Usage: init.py COMMAND...

The first process of a container takes all others with it when it ends: a rig that moves would be left unbraked. So:
- a server that is killed is started anew, beside the rigs, and adopts them; five times a minute at most;
- one that ends by itself, or is told to (SIGTERM, SIGINT), ends the container, once every other process has ended: rigs
  that are still there are told to (SIGTERM: they brake inside their limits), and are waited for;
- processes whose parents are gone are reaped.
"""

import contextlib
import os
import signal
import sys
import time
from pathlib import Path

_OFTEN, _WITHIN_S = 5, 60.0
_TOLD_S = 20.0  # for rigs to brake; below the grace that the engine gives (compose.yaml)
_ASK_S = 0.02
_PAUSE_S = 0.5  # for what belonged to the server to end with it, and free its port


class Init:
    """Of one container."""

    def __init__(self, command: list[str]) -> None:
        self._command = command
        self._server = 0
        self._started: list[float] = []
        self._asked: int | None = None  # the signal that ends it all

    def run(self) -> int:
        """Until the container ends: its exit status."""
        for number in (signal.SIGTERM, signal.SIGINT, signal.SIGHUP, signal.SIGQUIT):
            signal.signal(number, self._pass_on)
        self._start()
        while True:
            pid, status = os.waitpid(-1, 0)
            if pid != self._server:
                continue
            self._server = 0
            code = os.waitstatus_to_exitcode(status)
            if self._asked is None and (code < 0 or (code and len(self._started) > 1)) and self._may_start():
                how = f"was killed by signal {-code}" if code < 0 else f"ended with status {code}"
                self._say(f"the server {how}: it is started anew, and adopts the rigs")
                time.sleep(_PAUSE_S)
                self._start()
                continue
            self._end_others()
            return 128 - code if code < 0 else code

    def _pass_on(self, number: int, _frame: object) -> None:
        self._asked = number
        if self._server:
            os.kill(self._server, number)

    def _may_start(self) -> bool:
        now = time.monotonic()
        self._started = [at for at in self._started if now - at < _WITHIN_S]
        return len(self._started) < _OFTEN

    def _start(self) -> None:
        self._started.append(time.monotonic())
        self._server = os.posix_spawnp(
            self._command[0],
            self._command,
            os.environ,
            setsigdef=[signal.SIGPIPE, signal.SIGXFSZ],
        )

    def _end_others(self) -> None:
        """Tell what is left to end, and wait for it: a rig that moves brakes first."""
        until = time.monotonic() + _TOLD_S
        for pid in _orphans():
            _kill(pid)
        while time.monotonic() < until:
            try:
                if os.waitpid(-1, os.WNOHANG) == (0, 0):
                    time.sleep(_ASK_S)
            except ChildProcessError:
                return  # nobody is left: those whose parents are gone are ours
        self._say(f"these did not end within {_TOLD_S:g} s: {', '.join(map(str, _orphans()))}")

    def _say(self, text: str) -> None:
        sys.stderr.write(f"init: {text}\n")
        sys.stderr.flush()


def _orphans() -> list[int]:
    """The rigs' processes, whose server is gone; what they started themselves ends by itself after them."""
    return [int(pid) for pid in Path("/proc/1/task/1/children").read_text().split()]


def _kill(pid: int) -> None:
    with contextlib.suppress(ProcessLookupError):
        os.kill(pid, signal.SIGTERM)


if __name__ == "__main__":
    if os.getpid() != 1 or len(sys.argv) < 2:
        sys.exit("init.py COMMAND...: to be the first process of a container")
    sys.exit(Init(sys.argv[1:]).run())
