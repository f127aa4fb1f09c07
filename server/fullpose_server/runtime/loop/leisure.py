"""What only a rig at rest has time for: collecting garbage, its recorder's life, and whether anybody needs it."""

import gc
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from fullpose_server.runtime.loop.event_log import EventLog
from fullpose_server.session.states import State

_COLLECT_S = 10.0
_REVIVE_S = 0.5


class Recorder(Protocol):
    """The recorder, a child of the rig process."""

    def revive(self) -> int | None:
        """Start it anew where it has ended: its process's number then, or None."""
        ...


class Leisure:
    """Looks after each tick whether there is time, and does it. `header` is the shared one."""

    def __init__(
        self, recorder: Recorder, log: EventLog, header: NDArray[np.void], exit_idle_s: float, now: float
    ) -> None:
        self._recorder = recorder
        self._log = log
        self._header = header
        self._exit_idle_s = exit_idle_s
        self._collected = self._looked = 0.0
        self._idle_since = now
        self.unneeded = False  # at rest, and no server for long: the process may end

    def after_tick(self, now: float, state: State, *, moving: bool) -> bool:
        """Whether something was done that may have taken long."""
        resting = not moving and state is not State.ARMED
        if not resting or now - int(self._header["server_beat_ns"][0]) / 1e9 < 1.0:
            self._idle_since = now
        elif now - self._idle_since > self._exit_idle_s:
            self._log.add("exit", why=f"at rest, and no server for {self._exit_idle_s:g} s")
            self.unneeded = True
        if not resting:
            return False
        revived = now - self._looked > _REVIVE_S and self._revived(now)
        if now - self._collected <= _COLLECT_S:
            return revived
        self._collected = now
        gc.collect()
        return True

    def _revived(self, now: float) -> bool:
        """What was flown without it is still in the ring, for a while: it is wanted soon."""
        self._looked = now
        pid = self._recorder.revive()
        if pid is None:
            return False
        self._log.add("recorder_restarted", pid=pid)
        return True
