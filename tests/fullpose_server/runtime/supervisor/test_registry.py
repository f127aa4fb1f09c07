"""The rig processes of a server: one start however many ask, and nothing kept of rigs that there are not."""

import asyncio
import threading
from pathlib import Path

import pytest

from fullpose_server.errors import NotFoundError
from fullpose_server.formats.rig_file import RigStore
from fullpose_server.runtime.contract.config import RigConfig
from fullpose_server.runtime.supervisor.errors import HostError
from fullpose_server.runtime.supervisor.registry import RigHosts


def kept(hosts: RigHosts) -> int:
    """Entries of every table that the registry holds."""
    return sum(len(held) for held in vars(hosts).values() if isinstance(held, dict))


def test_nothing_is_kept_of_rigs_that_there_are_not(tmp_path: Path) -> None:
    def config(rig: str) -> RigConfig:
        raise NotFoundError("rig", rig)

    async def ask() -> None:
        hosts = RigHosts(RigStore(tmp_path), config, lambda rig: tmp_path / rig)
        for number in range(20):
            with pytest.raises(NotFoundError):
                await hosts.ensure(f"unknown-{number}")
        assert kept(hosts) == 0
        await hosts.close(stop_rigs=False)

    asyncio.run(ask())


def test_a_start_that_many_wait_for_is_one_and_outlives_who_asked_first(tmp_path: Path) -> None:
    asked, go = [], threading.Event()

    def config(rig: str) -> RigConfig:
        asked.append(rig)
        assert go.wait(60.0)
        raise HostError(f"{rig} does not come up")

    async def ask() -> None:
        hosts = RigHosts(RigStore(tmp_path), config, lambda rig: tmp_path / rig)
        first, second = (asyncio.create_task(hosts.ensure("rig")) for _ in range(2))
        await asyncio.to_thread(lambda: None)  # both have begun
        first.cancel()
        with pytest.raises(asyncio.CancelledError):
            await first
        go.set()
        with pytest.raises(HostError, match="does not come up"):
            await second
        assert asked == ["rig"]
        assert kept(hosts) == 0
        await hosts.close(stop_rigs=False)

    asyncio.run(ask())
