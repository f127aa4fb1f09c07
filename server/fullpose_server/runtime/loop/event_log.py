"""Events for the recorder and the server's audit log, with their times."""

from typing import Any

from fullpose_server.runtime.contract.shared_memory import Shared
from fullpose_server.runtime.loop.clock import Clock


class EventLog:
    """Adds events to the shared memory's ring of them."""

    def __init__(self, shared: Shared, clock: Clock) -> None:
        self._shared = shared
        self._clock = clock

    def add(self, kind: str, **content: Any) -> None:
        """Log one event."""
        times = {"time_ns": self._clock.monotonic_ns(), "wall_ns": self._clock.wall_ns()}
        self._shared.add_event({"kind": kind, **times, **content})
