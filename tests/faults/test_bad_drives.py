"""Drives that hang, raise or keep the interpreter's lock: named, braked, stops answered, and the process replaced."""

import asyncio
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

from fullpose_server.runtime.contract.config import RigConfig, encode
from fullpose_server.runtime.contract.rig_paths import RigPaths
from fullpose_server.runtime.recording.mcap_reader import is_complete, read_events, read_samples
from fullpose_server.runtime.supervisor.rig_client import RigHost
from fullpose_server.session.states import STATES
from tests.fullpose_server.runtime.rigs import Operator, config_of, hosted, plan_of, within_limits, written
from tests.support.bad_drives import with_bad_drives
from tests.support.waiting import soon, until


class Bad:
    """A rig with a drive that turns bad when it is told."""

    def __init__(self, folder: Path, monkeypatch: pytest.MonkeyPatch, fault: str, call: str) -> None:
        with_bad_drives(folder, monkeypatch)
        self.folder = folder
        self.trigger, self.brakes = folder / "trigger", folder / "brakes"
        options = {"fault": fault, "call": call, "trigger": str(self.trigger), "brakes": str(self.brakes)}
        self.config: RigConfig = config_of(folder, drive="bad", drive_options=options)

    async def fly(self, operator: Operator) -> None:
        await operator.fly(written(self.folder / "plan", plan_of(self.config.rig, 20.0)))

    def log(self) -> str:
        return RigPaths(self.config.directory).log.read_text()


# A server that flies the rig of the settings until it is killed.
SERVER = """
import asyncio, sys
from pathlib import Path
from fullpose_server.runtime.contract import config
from fullpose_server.runtime.supervisor.rig_client import RigHost
from tests.fullpose_server.runtime.rigs import Operator

async def main(settings, plan):
    host = RigHost(config.decode(Path(settings).read_bytes()))
    await host.start()
    await Operator(host).fly(Path(plan))
    print(host.snapshot().health.rig_pid, flush=True)
    await asyncio.sleep(600)

asyncio.run(main(*sys.argv[1:]))
"""


def running(pid: int) -> bool:
    return Path(f"/proc/{pid}").exists()


async def named(host: RigHost, code: str) -> Any:
    """The alarm, once it stands."""
    await soon(lambda: code in [a.code for a in host.snapshot().alarms])
    return next(a for a in host.snapshot().alarms if a.code == code)


async def replaced(host: RigHost, pid: int) -> None:
    await soon(lambda: host.snapshot().health.rig_pid != pid and host.snapshot().health.rig_alive)


@pytest.mark.parametrize("call", ["read", "write"])
def test_a_call_that_never_returns_is_named_braked_and_its_process_replaced(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, call: str
) -> None:
    async def fly() -> None:
        bad = Bad(tmp_path, monkeypatch, "hangs", call)
        async with hosted(bad.config) as (host, operator):
            await bad.fly(operator)
            pid = host.snapshot().health.rig_pid
            bad.trigger.touch()
            alarm = await named(host, "drive_hangs")
            assert f"drive bad: {call} has not returned for" in alarm.message
            assert "its emergency brake was used" in alarm.message
            assert alarm.first
            assert bad.brakes.read_text() == "used"
            stopped = await host.stop("anna")
            assert stopped.unknown is None or not host.snapshot().health.rig_alive
            bad.trigger.unlink()
            await replaced(host, pid)
            told = host.snapshot()
            assert told.state == "disconnected"
            (lost,) = told.alarms
            assert lost.code == "rig_process_lost"
            assert f"drive bad: {call} has not returned" in lost.message
            within_limits(host.samples(0, 1 << 20)[0], host)
        assert "tests/support/bad_drives.py" in bad.log()  # where it hangs
        (record,) = (tmp_path / "runs").iterdir()
        events = read_events(record)
        (end,) = (e for e in events if e["kind"] == "run_end")
        assert (end["how"], end["code"]) == ("fault", "drive_hangs")
        assert STATES[read_samples(record)["state"][-1]] == "faulted"

    asyncio.run(fly())


def test_a_call_that_returns_late_is_named_and_the_process_goes_on(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    async def fly() -> None:
        bad = Bad(tmp_path, monkeypatch, "pauses", "read")
        async with hosted(bad.config) as (host, operator):
            await bad.fly(operator)
            pid = host.snapshot().health.rig_pid
            bad.trigger.touch()
            alarm = await named(host, "drive_hangs")
            assert "read has not returned" in alarm.message
            bad.trigger.unlink()
            await operator.until("faulted")
            await operator.recover()
            assert host.snapshot().state == "idle"
            assert host.snapshot().health.rig_pid == pid

    asyncio.run(fly())


def test_a_drive_that_keeps_the_interpreter_s_lock_is_named_by_the_server_and_killed(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    async def fly() -> None:
        bad = Bad(tmp_path, monkeypatch, "hangs_alone", "read")
        async with hosted(bad.config) as (host, operator):
            await bad.fly(operator)
            pid = host.snapshot().health.rig_pid
            bad.trigger.touch()
            alarm = await named(host, "drive_hangs")
            assert "drive bad: read has not returned for" in alarm.message
            assert "watchdog" in alarm.message
            bad.trigger.unlink()
            await replaced(host, pid)
            (lost,) = host.snapshot().alarms
            assert "drive bad: read has not returned" in lost.message
            assert "signal 9" in lost.message

    asyncio.run(fly())


@pytest.mark.parametrize(
    ("fault", "error", "call"),
    [
        ("raises", "OSError: [Errno 5] the card has gone", "read"),
        ("raises", "OSError: [Errno 5] the card has gone", "write"),
        ("exhausts", "MemoryError: ", "read"),
    ],
)
def test_a_call_that_raises_is_named_with_its_time_and_its_traceback_is_in_the_log(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, fault: str, error: str, call: str
) -> None:
    async def fly() -> None:
        bad = Bad(tmp_path, monkeypatch, fault, call)
        async with hosted(bad.config) as (host, operator):
            await bad.fly(operator)
            pid = host.snapshot().health.rig_pid
            bad.trigger.touch()
            alarm = await named(host, "drive_failed")
            assert f"drive bad: {call} raised {error} (after" in alarm.message
            assert alarm.unit == "ms"
            assert alarm.first
            assert host.snapshot().state == "faulted"
            bad.trigger.unlink()
            await operator.recover()
            assert host.snapshot().health.rig_pid == pid
        assert "Traceback" in bad.log()
        assert f"in _{fault.removesuffix('s')}" in bad.log()

    asyncio.run(fly())


@pytest.mark.parametrize("fault", ["hangs", "hangs_alone"])
def test_no_process_is_left_behind_after_the_server_s_end(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, fault: str
) -> None:
    bad = Bad(tmp_path, monkeypatch, fault, "read")
    plan = written(tmp_path / "plan", plan_of(bad.config.rig, 20.0))
    settings = tmp_path / "settings.json"
    settings.write_bytes(encode(bad.config))
    server = subprocess.Popen([sys.executable, "-c", SERVER, str(settings), str(plan)], stdout=subprocess.PIPE)
    assert server.stdout is not None
    try:
        pid = int(server.stdout.readline())
        second = subprocess.run(
            [
                sys.executable,
                "-m",
                "fullpose_server.runtime.loop.process",
                "--config",
                RigPaths(tmp_path / "rig").config,
            ],
            capture_output=True,
            text=True,
            check=False,
        )
        assert (second.returncode, "another process runs test" in second.stderr) == (1, True)
        server.kill()
        bad.trigger.touch()
        until(lambda: not running(pid))
        assert RigPaths(bad.config.directory).running() is None
    finally:
        server.kill()
        server.wait()
        server.stdout.close()
    (record,) = (tmp_path / "runs").iterdir()
    until(lambda: is_complete(record))  # by its recorder, which ends after it


def test_an_orderly_end_leaves_no_process_either(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    async def fly() -> None:
        bad = Bad(tmp_path, monkeypatch, "hangs_alone", "read")
        async with hosted(bad.config) as (host, operator):
            await operator.take()
            await operator.must("connect")
            pid = host.snapshot().health.rig_pid
            bad.trigger.touch()
            await named(host, "drive_hangs")
        assert not running(pid)
        assert RigPaths(bad.config.directory).running() is None

    asyncio.run(fly())
