"""The one way that tests wait for another process or thread: for what they wait for, never for a time.

A slow machine makes such a test slow, not red: the patience is for what never comes.
"""

import asyncio
import time
from collections.abc import Awaitable, Callable
from typing import TypeVar

Found = TypeVar("Found")
EVERY_S = 0.02


def until(found: Callable[[], Found | None], patience_s: float = 120.0, every_s: float = EVERY_S) -> Found:
    """What `found` returns, asked again until it is true. Raises `AssertionError` where it never is."""
    end = time.monotonic() + patience_s
    while not (value := found()):
        assert time.monotonic() < end, f"still {value!r} after {patience_s} s"
        time.sleep(every_s)
    return value


async def soon(found: Callable[[], Found | None], patience_s: float = 120.0, every_s: float = EVERY_S) -> Found:
    """`until` for tests that are coroutines."""

    async def asked() -> Found | None:
        return found()

    return await answered(asked, patience_s, every_s)


async def answered(
    ask: Callable[[], Awaitable[Found | None]], patience_s: float = 120.0, every_s: float = EVERY_S
) -> Found:
    """What `ask` answers, asked again until it is true. Raises `AssertionError` where it never is."""
    end = time.monotonic() + patience_s
    while not (value := await ask()):
        assert time.monotonic() < end, f"still {value!r} after {patience_s} s"
        await asyncio.sleep(every_s)
    return value
