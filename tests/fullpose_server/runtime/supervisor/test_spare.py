"""The rig process in reserve: it is the next rig's that needs one, and belongs to the server until then."""

import asyncio
import os
import signal
import subprocess
import sys
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from pathlib import Path

import pytest

from fullpose_server.runtime.contract.hung import suspended as is_suspended
from fullpose_server.runtime.contract.rig_paths import RigPaths
from fullpose_server.runtime.supervisor import launcher
from fullpose_server.runtime.supervisor import spare as module
from fullpose_server.runtime.supervisor.errors import HostError
from fullpose_server.runtime.supervisor.rig_client import RigHost
from fullpose_server.runtime.supervisor.spare import Spare
from tests.fullpose_server.runtime.rigs import Operator, config_of, plan_of, written
from tests.support.waiting import soon, until

SERVER = """
import asyncio
from fullpose_server.runtime.supervisor import spare

async def main():
    spare.AFTER_S = 0.0
    kept = spare.Spare()
    kept.make_soon()
    while not kept.pid:
        await asyncio.sleep(0.01)
    print(kept.pid, flush=True)
    await asyncio.sleep(600)

asyncio.run(main())
"""


@pytest.fixture(autouse=True)
def at_once(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(module, "AFTER_S", 0.0)
    monkeypatch.setattr(launcher, "_ORDERS_S", 120.0)  # a starved machine takes long to get the spare ready


def exists(pid: int) -> bool:
    return Path(f"/proc/{pid}").exists()


@asynccontextmanager
async def rig_with_spare(tmp_path: Path) -> AsyncIterator[tuple[RigHost, Spare]]:
    """A rig that runs, and a spare beside it."""
    spare = Spare()
    host = RigHost(config_of(tmp_path), None, spare)
    await host.start()
    try:
        await soon(lambda: spare.pid)
        yield host, spare
    finally:
        await host.close(stop_rig=True)
        spare.close()


async def replaced(host: RigHost) -> int:
    """Kill the rig's process: the number of the next one, once it runs."""
    pid = host.snapshot().health.rig_pid
    os.kill(pid, signal.SIGKILL)
    await soon(lambda: host.snapshot().health.rig_pid != pid and host.snapshot().health.rig_alive)
    return host.snapshot().health.rig_pid


def test_a_rig_whose_process_dies_has_the_spare_and_flies_with_it(tmp_path: Path) -> None:
    async def fly() -> None:
        async with rig_with_spare(tmp_path) as (host, spare):
            for _ in range(2):  # it is made anew
                waiting = await soon(lambda: spare.pid)
                assert await replaced(host) == waiting
                (alarm,) = host.snapshot().alarms
                assert alarm.code == "rig_process_lost"
            operator = Operator(host)
            await operator.take("takeover")
            await operator.must("acknowledge")
            await operator.must("connect")
            await operator.must("load", plan_folder=str(written(tmp_path / "plan", plan_of(host.rig, 1.0))))
            await operator.must("arm")  # its recorder runs
            await operator.must("start")
            assert (await operator.until("armed", "faulted")).state == "armed"
            await soon(lambda: list(host.config.runs.iterdir()))
        assert f"ready, pid {waiting}" in RigPaths(host.config.directory).log.read_text()

    asyncio.run(fly())


def test_a_spare_that_has_died_is_passed_over(tmp_path: Path) -> None:
    async def fly() -> None:
        async with rig_with_spare(tmp_path) as (host, spare):
            dead = spare.pid
            os.kill(dead, signal.SIGKILL)
            assert await replaced(host) != dead

    asyncio.run(fly())


def test_a_spare_that_has_died_is_made_anew(tmp_path: Path) -> None:
    async def fly() -> None:
        async with rig_with_spare(tmp_path) as (_, spare):
            dead = spare.pid
            os.kill(dead, signal.SIGKILL)
            await soon(lambda: spare.pid not in (0, dead))
            assert not exists(dead)

    asyncio.run(fly())


def test_a_rig_that_cannot_be_started_does_not_use_the_reserve_up(tmp_path: Path) -> None:
    async def fly() -> None:
        async with rig_with_spare(tmp_path) as (_, spare):
            taken = spare.pid
            broken = RigHost(config_of(tmp_path / "broken", drive="nosuch"), None, spare)
            with pytest.raises(HostError, match="no drive 'nosuch'"):
                await broken.start()
            await soon(lambda: spare.pid not in (0, taken))

    asyncio.run(fly())


def test_a_spare_that_is_suspended_is_ended_and_holds_no_rig_up(tmp_path: Path) -> None:
    async def fly() -> None:
        async with rig_with_spare(tmp_path) as (host, spare):
            suspended = spare.pid
            os.kill(suspended, signal.SIGSTOP)
            await soon(lambda: is_suspended(suspended))
            assert await replaced(host) != suspended
            assert not exists(suspended)

    asyncio.run(fly())


def test_a_spare_that_does_not_take_its_orders_is_ended_and_another_started(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(launcher, "_ORDERS_S", 0.1)
    deaf = subprocess.Popen(["sleep", "3600"])

    class Deaf(Spare):
        def take(self, paths: RigPaths) -> int:  # noqa: ARG002
            return deaf.pid

    async def fly() -> None:
        host = RigHost(config_of(tmp_path), None, Deaf())
        await host.start()
        try:
            assert host.snapshot().health.rig_alive
            assert not exists(deaf.pid)
        finally:
            await host.close(stop_rig=True)

    try:
        asyncio.run(fly())
    finally:
        deaf.kill()
        deaf.wait()


def test_it_ends_with_the_server_and_with_its_close(tmp_path: Path) -> None:
    server = subprocess.Popen([sys.executable, "-c", SERVER], stdout=subprocess.PIPE)
    assert server.stdout is not None
    pid = int(server.stdout.readline())
    server.kill()
    server.wait()
    server.stdout.close()
    until(lambda: not exists(pid))

    async def closed() -> int:
        spare = Spare()
        spare.make_soon()
        made = await soon(lambda: spare.pid)
        spare.close()
        return made

    assert not exists(asyncio.run(closed()))
