"""The life of a rig's process when it cannot be started anew."""

import asyncio
import gc
import os
import signal
import sys
import warnings
from pathlib import Path

import pytest

from fullpose_server.runtime.contract.config import RigConfig
from fullpose_server.runtime.contract.rig_paths import RigPaths
from fullpose_server.runtime.supervisor.launcher import Launcher
from fullpose_server.runtime.supervisor.rig_client import RigHost
from tests.fullpose_server.runtime.rigs import config_of, hosted
from tests.support.waiting import soon


def test_a_start_anew_that_fails_is_told_in_the_rig_s_log_and_leaves_no_file_open(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    async def die() -> None:
        config = config_of(tmp_path)
        async with hosted(config) as (host, _):
            log = config.directory / "rig.log"
            monkeypatch.setattr(sys, "executable", "/bin/false")
            with warnings.catch_warnings(record=True) as told:
                warnings.simplefilter("always")
                os.kill(host.snapshot().health.rig_pid, signal.SIGKILL)
                await soon(lambda: "server: the rig process of test ended at once" in log.read_text("utf-8"))
                gc.collect()
            assert [str(warning.message) for warning in told if warning.category is ResourceWarning] == []
            (fault,) = host.faults()  # it is watched on
            assert fault.startswith("its process cannot be started: the rig process of test ended at once")
            assert not host.snapshot().health.rig_alive

    asyncio.run(die())


def test_a_watch_that_ends_by_an_error_of_ours_is_told_in_the_log_and_as_a_fault(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    async def wrong(_: Launcher, config: RigConfig) -> int:
        raise KeyError(config.name)

    async def die() -> None:
        async with hosted(config_of(tmp_path)) as (host, _):
            assert host.faults() == []
            monkeypatch.setattr(Launcher, "spawn", wrong)
            os.kill(host.snapshot().health.rig_pid, signal.SIGKILL)
            assert await soon(host.faults) == ["its process is not watched any more"]
        (told,) = (record for record in caplog.records if record.levelname == "ERROR")
        assert told.getMessage() == "rig test is not watched any more"
        assert told.exc_info is not None
        assert told.exc_info[0] is KeyError

    asyncio.run(die())


def test_a_process_that_an_earlier_server_has_just_started_is_awaited_not_doubled(tmp_path: Path) -> None:
    async def start() -> None:
        config = config_of(tmp_path)
        earlier, later = RigHost(config), RigHost(config)
        starting = asyncio.create_task(earlier.start())
        try:
            await soon(RigPaths(config.directory).held)
            await later.start()
            await starting
            assert later.adopted
            assert later.snapshot().health.rig_pid == earlier.snapshot().health.rig_pid
        finally:
            await asyncio.gather(starting, return_exceptions=True)
            await later.close(stop_rig=False)
            await earlier.close(stop_rig=True)

    asyncio.run(start())
