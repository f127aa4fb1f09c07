"""The watch finds what holds the loop up, and takes no waiting and no garbage for it."""

import asyncio
import gc
import time

import pytest

from tests.support.loop_watch import LONGEST_S, watched_loop


def burn(seconds: float) -> None:
    end = time.thread_time() + seconds
    while time.thread_time() < end:
        pass


def test_a_callback_that_computes_is_named_and_one_that_waits_or_computes_elsewhere_is_not() -> None:
    async def main() -> None:
        watch.begin()
        await asyncio.sleep(0)
        await asyncio.to_thread(burn, 2 * LONGEST_S)
        gc.collect()
        await asyncio.sleep(0)
        watch.check()
        asyncio.get_running_loop().call_soon(burn, 2 * LONGEST_S)
        await asyncio.sleep(0)
        await asyncio.sleep(0)

    with watched_loop() as watch:
        asyncio.run(main())
    with pytest.raises(AssertionError, match="burn"):
        watch.check()
    assert len(watch.slow) == 1
