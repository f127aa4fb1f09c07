"""The server's heartbeat to a rig process: a thread, because it says that the server lives, not that its loop is free.

Whether the operator is there the lease tells.
"""

import threading
import time

from fullpose_server.runtime.supervisor.process_view import ProcessView

BEAT_S = 0.05


class Heartbeat:
    """To the newest process that `view` shows, from construction until `stop`."""

    def __init__(self, view: ProcessView, name: str) -> None:
        self._view = view
        self._ending = threading.Event()
        self._thread = threading.Thread(target=self._run, name=f"heartbeat to {name}", daemon=True)
        self._thread.start()

    @property
    def alive(self) -> bool:
        """Whether it beats."""
        return self._thread.is_alive()

    def stop(self) -> None:
        """Beat no more."""
        self._ending.set()
        self._thread.join()

    def _run(self) -> None:
        while not self._ending.wait(BEAT_S):
            self._view.memory.header["server_beat_ns"] = time.monotonic_ns()
