"""Which callbacks held an event loop up for longer than it may be: the rule of the server's own loop.

The time is the thread's own (`thread_time`): on a loaded machine a callback waits for the processor, and that is not
its fault. Collections of garbage, which come when they come, are not counted.
"""

import asyncio
import gc
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from typing import Any

import pytest

LONGEST_S = 0.02


@dataclass
class LoopWatch:
    """What one loop's callbacks took. `slow`: (callback, seconds of CPU) of those above `LONGEST_S`."""

    slow: list[tuple[str, float]] = field(default_factory=list)
    thread: int | None = None  # the loop's; None: not known yet, nothing is watched
    _collecting_since: float = 0.0
    _collected: float = 0.0

    def begin(self) -> None:
        """Watch the loop of the calling thread from here on: what it does to start is not counted."""
        self.thread = threading.get_ident()

    def check(self) -> None:
        """Raises `AssertionError` naming every callback that was too long."""
        told = "\n".join(f"{seconds * 1e3:.0f} ms of CPU: {name}" for name, seconds in self.slow)
        assert not self.slow, f"callbacks over {LONGEST_S * 1e3:.0f} ms on the event loop:\n{told}"

    def run(self, handle: Any, original: Any) -> None:
        """One callback."""
        if threading.get_ident() != self.thread:
            original(handle)
            return
        # A step of a task: the handle's own text names the wrapper, the task names the coroutine.
        task = getattr(handle._callback, "__self__", handle)
        name, self._collected = repr(task), 0.0
        begin = time.thread_time()
        try:
            original(handle)
        finally:
            took = time.thread_time() - begin - self._collected
            if took > LONGEST_S:
                self.slow.append((name, took))

    def collection(self, phase: str, _info: dict[str, int]) -> None:
        """A collection of garbage begins or ends."""
        if threading.get_ident() != self.thread:
            return
        if phase == "start":
            self._collecting_since = time.thread_time()
        else:
            self._collected += time.thread_time() - self._collecting_since


@contextmanager
def watched_loop() -> Iterator[LoopWatch]:
    """A watch over the loop whose thread calls `begin`, for asyncio's own loop (not uvloop)."""
    watch = LoopWatch()
    original = asyncio.Handle._run
    with pytest.MonkeyPatch.context() as patched:
        patched.setattr(asyncio.Handle, "_run", lambda handle: watch.run(handle, original))
        gc.callbacks.append(watch.collection)
        try:
            yield watch
        finally:
            gc.callbacks.remove(watch.collection)
