"""Processes killed and stopped for real: limits kept, the cause named, the record readable, the session adopted.

FAULT_ROUNDS sets how many random moments are tried: a few by default; a campaign, on a machine with nothing else to
do, tries a hundred and holds the server to 200 ms for saying that the rig process is gone.
"""

import asyncio
import contextlib
import os
import signal
import time
from pathlib import Path

import numpy as np
import pytest
from mcap.stream_reader import StreamReader

from fullpose_server.runtime.recording.mcap_reader import is_complete, read_events
from fullpose_server.session.machine import SilencePolicy
from tests.faults.records import messages
from tests.fullpose_server.runtime.rigs import codes_of, config_of, hosted, plan_of, within_limits, written
from tests.support.waiting import soon

CAMPAIGN = "FAULT_ROUNDS" in os.environ
MOMENTS = int(os.environ.get("FAULT_ROUNDS", "3"))
SAID_S = 0.2 if CAMPAIGN else 5.0  # by then the server has said what happened
QUICK = SilencePolicy(0.8, 8.0, 60.0)


@pytest.mark.parametrize("seed", range(MOMENTS))
def test_a_killed_rig_process_is_said_at_once_and_its_record_is_whole(tmp_path: Path, seed: int) -> None:
    async def fly() -> None:
        config = config_of(tmp_path)
        plan = written(tmp_path / "plan", plan_of(config.rig, 6.0))
        async with hosted(config) as (host, operator):
            await operator.fly(plan)
            await asyncio.sleep(float(np.random.default_rng(seed).uniform(0.1, 4.0)))
            pid = host.snapshot().health.rig_pid
            shared = host.memory
            revision = host.revision
            killed = time.monotonic()
            os.kill(pid, signal.SIGKILL)
            await host.wait_change(revision)
            assert time.monotonic() - killed < SAID_S
            told = host.snapshot()
            assert not told.health.rig_alive
            assert (told.state, told.allowed) == ("disconnected", [])
            last = shared.ring.head
            deadline = time.monotonic() + 60.0
            while not (again := host.snapshot()).health.rig_alive and time.monotonic() < deadline:
                with contextlib.suppress(TimeoutError):  # a heartbeat may be late, and nothing changes when it comes
                    await asyncio.wait_for(host.wait_change(again.revision), 0.2)
            assert again.health.rig_pid != pid
            assert again.state == "disconnected"
            assert again.revision > told.revision
            (alarm,) = again.alarms
            assert alarm.code == "rig_process_lost"
            assert "signal 9" in alarm.message
            assert "running" in alarm.message
        (record,) = (tmp_path / "runs").iterdir()
        numbers = messages(record)
        assert (np.diff(numbers) == 1).all()
        assert last - numbers[-1] <= 200

    asyncio.run(fly())


def test_a_process_killed_while_it_published_keeps_its_last_words(tmp_path: Path) -> None:
    async def fly() -> None:
        config = config_of(tmp_path)
        async with hosted(config) as (host, operator):
            await operator.arm(written(tmp_path / "plan", plan_of(config.rig, 1.0)))
            assert host.snapshot().state == "armed"
            pid = host.snapshot().health.rig_pid
            shared = host.memory
            os.kill(pid, signal.SIGSTOP)
            shared._text["version"] += 1  # as it is in the middle of it
            os.kill(pid, signal.SIGKILL)
            deadline = time.monotonic() + 60.0
            while (told := host.snapshot()).health.rig_pid == pid or not told.health.rig_alive:
                assert told.plan is not None or told.health.rig_pid != pid
                assert time.monotonic() < deadline
                await asyncio.sleep(0.01)
            (alarm,) = told.alarms
            assert alarm.code == "rig_process_lost"
            assert "while armed" in alarm.message

    asyncio.run(fly())


# In the rig's process, once the file is there, the next tick fails with an error of ours.
BROKEN = """
import os, sys, time
_time_ns = time.time_ns
def _broken():
    fault = os.environ["BROKEN_TICK"]
    if "fullpose_server.runtime.loop.process" in " ".join(sys.orig_argv) and os.path.exists(fault):
        time.time_ns = _time_ns
        raise ZeroDivisionError("a fault of ours")
    return _time_ns()
time.time_ns = _broken
"""


def test_an_error_in_a_tick_brakes_and_is_named(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "site").mkdir()
    (tmp_path / "site" / "sitecustomize.py").write_text(BROKEN)
    fault = tmp_path / "fault"
    monkeypatch.setenv("PYTHONPATH", str(tmp_path / "site"))
    monkeypatch.setenv("BROKEN_TICK", str(fault))

    async def fly() -> None:
        config = config_of(tmp_path)
        async with hosted(config) as (host, operator):
            await operator.fly(written(tmp_path / "plan", plan_of(config.rig, 6.0)))
            pid = host.snapshot().health.rig_pid
            monkeypatch.delenv("PYTHONPATH")  # the next process is sound
            fault.touch()
            deadline = time.monotonic() + 60.0
            while (told := host.snapshot()).health.rig_pid == pid or not told.health.rig_alive:
                assert time.monotonic() < deadline
                await asyncio.sleep(0.01)
            (alarm,) = told.alarms
            assert alarm.code == "rig_process_lost"
            assert "exit status 1" in alarm.message
            assert "ZeroDivisionError: a fault of ours" in alarm.message
            assert "running" in alarm.message
        (record,) = (tmp_path / "runs").iterdir()
        assert "internal_error" in [e.get("code") for e in read_events(record)]

    asyncio.run(fly())


def test_a_killed_recorder_loses_no_more_than_a_chunk_and_is_replaced_at_rest(tmp_path: Path) -> None:
    async def fly() -> None:
        config = config_of(tmp_path)
        plan = written(tmp_path / "plan", plan_of(config.rig, 3.0))
        async with hosted(config) as (host, operator):
            await operator.fly(plan)
            await asyncio.sleep(2.0)
            shared = host.memory
            last = shared.ring.head
            os.kill(int(shared.header["recorder_pid"][0]), signal.SIGKILL)
            snapshot = await operator.until("armed", "faulted")
            assert snapshot.state == "armed"  # the loop never stops for the record
            assert codes_of(snapshot.alarms) == ["recorder_lost"]
            assert not snapshot.health.recorder.alive
            await operator.must("disarm")
            refused = await operator.say("arm")
            assert refused.error is not None
            assert refused.error.code == "no_record"
            for _ in range(100):
                if host.snapshot().health.recorder.alive:
                    break
                await asyncio.sleep(0.2)
                await operator.renew()
            await operator.must("arm")
        numbers = messages(next(iter((tmp_path / "runs").iterdir())))
        assert (np.diff(numbers) == 1).all()
        assert last - numbers[-1] <= 200

    asyncio.run(fly())


def test_a_stopped_rig_process_is_said_and_brakes_when_it_wakes(tmp_path: Path) -> None:
    async def fly() -> None:
        config = config_of(tmp_path, drive_options={"watchdog_s": 0.05})
        plan = written(tmp_path / "plan", plan_of(config.rig, 6.0))
        async with hosted(config) as (host, operator):
            await operator.fly(plan)
            await asyncio.sleep(1.5)
            pid = host.snapshot().health.rig_pid
            revision = host.revision
            os.kill(pid, signal.SIGSTOP)
            try:
                stopped = time.monotonic()
                await host.wait_change(revision)
                assert time.monotonic() - stopped < SAID_S + 0.05
                assert not host.snapshot().health.rig_alive
                await asyncio.sleep(0.5)
            finally:
                os.kill(pid, signal.SIGCONT)
            snapshot = await operator.until("faulted")
            first = next(a for a in snapshot.alarms if a.first)
            assert first.code in ("drive_watchdog", "lateness")
            within_limits(host.samples(0, 1 << 20)[0], host)
            await operator.recover()

    asyncio.run(fly())


def test_a_thousand_queued_commands_do_not_delay_an_estop(tmp_path: Path) -> None:
    async def fly() -> None:
        config = config_of(tmp_path)
        plan = written(tmp_path / "plan", plan_of(config.rig, 6.0))
        async with hosted(config) as (host, operator):
            await operator.fly(plan)
            await asyncio.sleep(1.0)
            shared = host.memory
            # Pretended loads: each is refused, but only after it was read and judged.
            queued = [asyncio.ensure_future(host.command("load", {}, "noise", None)) for _ in range(1000)]
            await asyncio.sleep(0.005)
            _, noted = shared.events_since(0)
            host.estop("panic")
            await asyncio.gather(*queued)
            asked, wrote = int(shared.header["estop_request_ns"][0]), int(shared.header["estop_wrote_ns"][0])
            assert wrote >= asked
            events, _ = shared.events_since(noted)
            commands = [e for e in events if e["kind"] == "command"]
            at = next(k for k, e in enumerate(commands) if e["command"] == "estop")
            before = [e for e in commands[:at] if e["time_ns"] > asked]
            assert len(before) <= 4  # what one tick takes from the queue, of a thousand
            await operator.until("estopped")
            within_limits(host.samples(0, 1 << 20)[0], host)

    asyncio.run(fly())


def test_stream_reader_is_the_library_s(tmp_path: Path) -> None:
    """What `recover_messages` reads of a whole file is what the library itself reads."""
    from mcap.records import Message

    async def fly() -> None:
        config = config_of(tmp_path)
        async with hosted(config) as (_, operator):
            await operator.arm(written(tmp_path / "plan", plan_of(config.rig, 0.5)))
            await operator.must("start")
            await operator.until("running")
            await operator.until("armed")
            await soon(lambda: any(map(is_complete, (tmp_path / "runs").glob("*.mcap"))))

    asyncio.run(fly())
    (record,) = (tmp_path / "runs").glob("*.mcap")
    with record.open("rb") as file:
        whole = [r.sequence for r in StreamReader(file).records if isinstance(r, Message) and r.channel_id == 1]
    assert messages(record) == whole
