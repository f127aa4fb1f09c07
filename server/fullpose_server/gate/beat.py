"""The gate's sign of life: one number in memory that it shares with who started it. No lock, no call, no event loop."""

import mmap
import os
import time
from typing import Self

_BYTES = 8


class Beat:
    """By the descriptor of the memory, which may be closed afterwards."""

    def __init__(self, descriptor: int) -> None:
        self._ns = memoryview(mmap.mmap(descriptor, _BYTES)).cast("q")

    @classmethod
    def made(cls) -> tuple[Self, int]:
        """New memory, and its descriptor to be handed on and closed."""
        descriptor = os.memfd_create("fullpose-gate-beat")
        os.ftruncate(descriptor, _BYTES)
        return cls(descriptor), descriptor

    @property
    def last_ns(self) -> int:
        """When it was said last [ns, monotonic]; 0: never."""
        return self._ns[0]

    def say(self) -> None:
        """The event loop runs."""
        self._ns[0] = time.monotonic_ns()
