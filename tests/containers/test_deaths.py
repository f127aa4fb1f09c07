"""The container's health when one of its processes dies: it says which, and says so no more once it is replaced."""

import asyncio
from pathlib import Path
from typing import Any

from fullpose_server.client import Client
from tests.containers.engine import Box, Engine
from tests.containers.flights import FILE, RIG, flown
from tests.support.waiting import until

STOP = 19


def said(box: Box, words: str) -> bool:
    """Whether the server's health has the words among its warnings."""
    told = box.health()
    return told is not None and told.get("status") == "degraded" and any(words in text for text in told["warnings"])


def well(box: Box) -> bool:
    told = box.health()
    return told is not None and told["status"] == "ok"


def flying(box: Box, folder: Path) -> None:
    async def fly() -> dict[str, Any]:
        async with Client(box.url, timeout_s=120.0, token=box.token) as client:
            return await flown(client, folder)

    asyncio.run(fly())


def disarmed(box: Box) -> None:
    """At rest, once its flight is over: one that is armed is not touched."""

    async def disarm() -> None:
        async with Client(box.url, timeout_s=120.0, token=box.token) as client:
            await client.wait_state(RIG, "armed")
            await client.take_lease(RIG, "takeover", "its flight is over")
            await client.command(RIG, "disarm")

    asyncio.run(disarm())


def test_a_dead_planner(box: Box) -> None:
    assert box.kill("planning.worker")
    until(lambda: said(box, "the planner's process has ended"))
    until(lambda: well(box))
    assert box.check() == (0, "ok")
    assert "its process ended by signal 9" in box.logs()


def test_a_dead_recorder_is_said_for_as_long_as_the_rig_flies(engine: Engine, tmp_path: Path) -> None:
    with engine.server(rig=FILE) as box:
        box.wait_healthy()
        flying(box, tmp_path)
        assert box.check() == (0, "ok")
        assert box.kill("recording.recorder")
        until(lambda: said(box, f"rig {RIG}: its recorder does not answer"))
        assert box.check() == (1, "dead: recorder")
        disarmed(box)
        until(lambda: well(box))


def test_a_dead_rig_process(engine: Engine, tmp_path: Path) -> None:
    with engine.server(rig=FILE) as box:
        box.wait_healthy()
        flying(box, tmp_path)
        assert box.kill("runtime.loop.process", STOP)  # as one that hangs: one that is killed is back in a second
        until(lambda: said(box, f"rig {RIG}: its process does not answer"))
        assert box.check() == (1, "dead: rig")
        box.kill("runtime.loop.process")
        until(lambda: (now := box.health()) is not None and now["rigs"][RIG]["rig_alive"])
        until(lambda: box.check() == (0, "ok"))


def test_a_dead_server(box: Box) -> None:
    """It is back before an engine has asked three times; while it is gone, the check fails."""
    assert box.kill("fullpose serve", STOP)
    status, text = box.check()
    assert status == 1
    assert text.startswith("the server does not answer")
    assert box.kill("fullpose serve")
    box.wait_healthy()
    assert box.check() == (0, "ok")
