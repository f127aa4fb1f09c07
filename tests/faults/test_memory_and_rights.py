"""A rig process without memory, or without the right to write where it must: said, and the rig stays what it was."""

import asyncio
import contextlib
import os
import resource
import signal
import subprocess
from collections.abc import Iterator
from pathlib import Path

import pytest

from tests.fullpose_server.runtime.rigs import codes_of, config_of, hosted, plan_of, within_limits, written
from tests.support.waiting import soon


@contextlib.contextmanager
def read_only(folder: Path) -> Iterator[None]:
    """Nothing can be written there meanwhile, by nobody: root may write where the rights say no."""
    mounted = subprocess.run(["mount", "--bind", str(folder), str(folder)], capture_output=True, check=False)
    if mounted.returncode:
        pytest.skip("mounting is not allowed here")
    try:
        subprocess.run(["mount", "-o", "remount,ro,bind", str(folder)], check=True, capture_output=True)
        yield
    finally:
        subprocess.run(["umount", "-l", str(folder)], check=True)


def test_a_plan_for_which_there_is_no_memory_is_refused_and_the_process_lives(tmp_path: Path) -> None:
    async def fly() -> None:
        config = config_of(tmp_path)
        small = written(tmp_path / "small", plan_of(config.rig, 4.0))
        large = written(tmp_path / "large", plan_of(config.rig, 600.0))
        async with hosted(config) as (host, operator):
            await operator.take()
            await operator.must("connect")
            pid = host.snapshot().health.rig_pid
            pages = int(Path(f"/proc/{pid}/statm").read_text().split()[0])  # noqa: ASYNC240
            most = pages * os.sysconf("SC_PAGE_SIZE") + (64 << 20)
            resource.prlimit(pid, resource.RLIMIT_AS, (most, most))
            refused = await operator.say("load", plan_folder=str(large))
            assert refused.error is not None
            assert refused.error.code == "out_of_memory"
            await operator.must("load", plan_folder=str(small))
            await operator.must("arm")
            await operator.must("start")
            snapshot = await operator.until("armed", "faulted")
            assert snapshot.state == "armed", snapshot.alarms
            assert snapshot.health.rig_pid == pid
            assert codes_of(snapshot.alarms) == []
            within_limits(host.samples(0, 1 << 20)[0], host)

    asyncio.run(fly())


def test_a_rig_s_folder_that_may_not_be_written_is_said_and_its_process_is_back_when_it_may(tmp_path: Path) -> None:
    async def fly() -> None:
        async with hosted(config_of(tmp_path)) as (host, _):
            pid = host.snapshot().health.rig_pid
            assert host.faults() == []
            with read_only(host.config.directory):
                os.kill(pid, signal.SIGKILL)
                (said,) = await soon(host.faults)
                assert "its process cannot be started" in said
                assert "Read-only file system" in said
            await soon(lambda: host.snapshot().health.rig_pid != pid and host.snapshot().health.rig_alive)
            await soon(lambda: not host.faults())

    asyncio.run(fly())


def test_a_folder_of_runs_that_may_not_be_written_any_more_bars_arming_and_is_said_in_flight(tmp_path: Path) -> None:
    async def fly() -> None:
        config = config_of(tmp_path)
        config.runs.mkdir()
        plan = written(tmp_path / "plan", plan_of(config.rig, 4.0))
        async with hosted(config) as (host, operator):
            await operator.arm(plan)
            with read_only(config.runs):
                await operator.must("start")
                snapshot = await operator.until("armed", "faulted")
                assert snapshot.state == "armed", snapshot.alarms  # the flight goes on without its record
                (said,) = (a for a in snapshot.alarms if a.code == "record_error")
                assert "Read-only file system" in said.message
                within_limits(host.samples(0, 1 << 20)[0], host)
                await operator.must("disarm")
                refused = await operator.say("arm")
                assert refused.error is not None
                assert refused.error.code == "no_record"
                assert "Read-only file system" in refused.error.message
            await operator.must("acknowledge")
            await operator.must("arm")

    asyncio.run(fly())
