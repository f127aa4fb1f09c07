"""A full disk, and drives that fail in flight: limits kept, the cause named, the record readable."""

import asyncio
import contextlib
import os
import random
import subprocess
import sys
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from fullpose_server.drives.packet import Order
from fullpose_server.formats.plan_folder import PlanFolder, sealed_plan
from fullpose_server.runtime.contract.config import RigConfig, Tolerance
from fullpose_server.runtime.recording.export import repair
from fullpose_server.runtime.recording.mcap_reader import is_complete, read_events, read_samples
from fullpose_server.runtime.supervisor.rig_client import RigHost
from fullpose_server.session.states import STATES
from tests.fullpose_server.drives.relay import Relay, relay
from tests.fullpose_server.drives.tables import emulator
from tests.fullpose_server.runtime.rigs import PATIENT, config_of, hosted, plan_of, ticked, within_limits, written
from tests.support.disks import small_disk
from tests.support.waiting import until


def test_a_disk_that_fills_up_in_flight_costs_the_record_and_not_the_flight(tmp_path: Path) -> None:
    async def fly(runs: Path) -> None:
        config = replace(config_of(tmp_path, min_free_mb=0.2), runs=runs)
        plan = written(tmp_path / "plan", plan_of(config.rig, 6.0))
        async with hosted(config) as (host, operator):
            await operator.fly(plan)
            snapshot = await operator.until("armed", "faulted")
            assert snapshot.state == "armed"
            codes = [a.code for a in snapshot.alarms]
            assert "record_error" in codes
            (full,) = (a for a in snapshot.alarms if a.code == "record_error")
            assert "No space left" in full.message
            rows, lost = host.samples(0, 1 << 20)
            assert lost == 0
            within_limits(rows, host)
            await operator.must("disarm")
            await asyncio.sleep(1.2)
            refused = await operator.say("arm")
            assert refused.error is not None
            assert refused.error.code == "disk_full"
        (record,) = runs.iterdir()  # noqa: ASYNC240
        assert not is_complete(record)
        kept = read_samples(record)
        assert len(kept) > 1000
        assert (np.diff(kept["seq"].astype(int)) == 1).all()
        whole = tmp_path / "whole.mcap"
        assert repair(record, whole) >= len(kept)
        assert is_complete(whole)
        np.testing.assert_array_equal(read_samples(whole)["seq"], kept["seq"])

    with small_disk(tmp_path / "disk", 1024) as runs:
        asyncio.run(fly(runs))


# A table on a starved machine lags by tens of milliseconds; what is tested here is the link.
WIDE = replace(PATIENT, following_deg=Tolerance(None, 45.0), attitude_deg=Tolerance(None, None))


def drive_fault(kind: str, frame: str | None, at_s: float = 4.5) -> dict[str, Any]:
    return {"faults": [{"kind": kind, "frame": frame, "at_s": at_s}]}


@pytest.mark.parametrize(
    ("kind", "frame", "code", "state"),
    [
        ("stuck", "middle", "following_error", "faulted"),
        ("runaway", "inner", "following_error", "faulted"),
        ("encoder", "outer", "drive_encoder", "faulted"),
        ("link", None, "link_lost", "disconnected"),
    ],
)
def test_a_failing_drive_is_named_and_the_rig_brakes(
    tmp_path: Path, kind: str, frame: str | None, code: str, state: str
) -> None:
    async def fly() -> None:
        config = config_of(tmp_path, drive_options=drive_fault(kind, frame))
        plan = written(tmp_path / "plan", plan_of(config.rig, 8.0))
        async with hosted(config) as (host, operator):
            await operator.arm(plan)
            await operator.must("start")
            snapshot = await operator.until("faulted", "disconnected", "armed")
            assert snapshot.state == state, snapshot.alarms
            first = next(a for a in snapshot.alarms if a.first)
            assert (first.code, first.frame) == (code, frame)
            within_limits(host.samples(0, 1 << 20)[0], host)
            await asyncio.sleep(1.5)
            if state == "faulted":
                newest = host.latest()
                assert newest is not None
                moving = np.abs(newest["measured_rate"][0])
                if frame is not None and kind == "runaway":
                    moving[["base", "outer", "middle", "inner"].index(frame)] = 0.0  # its brake is what failed
                assert moving.max() < 1.0
        (record,) = (tmp_path / "runs").iterdir()
        until(lambda: is_complete(record))  # the recorder ends after the rig's process
        assert code in [e.get("code") for e in read_events(record) if e["kind"] == "alarm"]

    asyncio.run(fly())


def test_a_jump_in_a_plan_is_caught_before_it_is_written(tmp_path: Path) -> None:
    async def fly() -> None:
        config = config_of(tmp_path)
        sound = plan_of(config.rig, 4.0)
        angles = np.array(sound.angles)
        angles[3000:, 2] += np.radians(2.0)
        jumping = sealed_plan(PlanFolder(sound.info, angles, sound.target, sound.error))
        folder = written(tmp_path / "plan", jumping)
        async with hosted(config) as (host, operator):
            await operator.arm(folder)
            await operator.must("start")
            snapshot = await operator.until("faulted", "armed")
            (alarm,) = [a for a in snapshot.alarms if a.severity != "warning"]  # a starved machine may be late
            assert (alarm.code, alarm.frame, alarm.first) == ("guard_rate", "middle", True)
            assert alarm.value is not None
            assert alarm.limit is not None
            assert abs(alarm.value) > abs(alarm.limit)
            rows, _ = host.samples(0, 1 << 20)
            within_limits(rows, host)
            assert rows["state"][-1] == STATES.index("faulted")

    asyncio.run(fly())


def test_a_table_that_vanishes_is_a_lost_link_and_can_be_connected_again(tmp_path: Path) -> None:
    async def fly() -> None:
        with emulator("--rig", "vertical-4", "--watchdog", "1.0") as (port, _):
            options = {"port": port, "link_lost_s": 0.3}
            config = config_of(tmp_path, rig="vertical-4", drive="udp", drive_options=options, guard=WIDE)
            plan = written(tmp_path / "plan", plan_of(config.rig, 8.0, swing=0.5))
            async with hosted(config) as (host, operator):
                await operator.fly(plan)
                await asyncio.sleep(1.0)
                os.kill(_child_on(port), 9)
                snapshot = await operator.until("disconnected", "armed", "faulted")
                assert snapshot.state == "disconnected", snapshot.alarms
                assert "link_lost" in [a.code for a in snapshot.alarms]
                gone = await operator.say("connect")
                assert gone.error is not None
                assert gone.error.code == "drive_unreachable"
                again = subprocess.Popen(  # noqa: ASYNC220
                    [
                        sys.executable,
                        "-m",
                        "fullpose_server.drives.testing.table_emulator",
                        "--port",
                        str(port),
                        "--seconds",
                        "60",
                    ],
                    stdout=subprocess.PIPE,
                )
                assert again.stdout is not None
                try:
                    again.stdout.readline()
                    await operator.must("connect")
                finally:
                    again.kill()
                    again.wait()
                    again.stdout.close()
                within_limits(host.samples(0, 1 << 20)[0], host)

    asyncio.run(fly())


@contextlib.contextmanager
def bad_network(tmp_path: Path, *arguments: str) -> Iterator[tuple[Relay, RigConfig]]:
    """A table behind a relay, and the settings of its rig."""
    with emulator("--rig", "vertical-4", *arguments) as (port, _), relay(port) as network:
        options = {"port": network.port, "link_lost_s": 2.0, "connect_s": 10.0}
        yield network, config_of(tmp_path, rig="vertical-4", drive="udp", drive_options=options, guard=WIDE)


def test_a_table_that_never_hears_enable_is_named_and_not_a_following_error(tmp_path: Path) -> None:
    async def fly() -> None:
        # The table's own watchdog is a patient one: a starved machine keeps the rig process from writing for 50 ms.
        with bad_network(tmp_path, "--watchdog", "1.0") as (network, config):
            network.loses = lambda command: command.order is Order.ENABLE
            plan = written(tmp_path / "plan", plan_of(config.rig, 4.0))
            async with hosted(config) as (host, operator):
                await operator.arm(plan)
                snapshot = await operator.until("faulted")
                (alarm,) = [a for a in snapshot.alarms if a.severity != "warning"]
                assert (alarm.code, alarm.first) == ("drive_not_enabled", True)
                assert "not confirmed" in alarm.message
                network.loses = lambda _: False
                await operator.recover()
                await operator.must("load", plan_folder=str(plan))
                await operator.must("arm")
                await ticked(host, 0.5)
                again = host.snapshot()
                assert again.state == "armed", again.alarms

    asyncio.run(fly())


def test_an_estop_that_does_not_power_the_table_off_is_said(tmp_path: Path) -> None:
    async def fly() -> None:
        with bad_network(tmp_path, "--watchdog", "1.0") as (network, config):
            plan = written(tmp_path / "plan", plan_of(config.rig, 4.0))
            async with hosted(config) as (host, operator):
                await operator.arm(plan)
                await asyncio.sleep(0.5)
                network.loses = lambda command: command.order is Order.DISABLE
                host.estop("test")
                await operator.until("estopped")
                await _alarm(host, "drive_not_disabled")
                snapshot = host.snapshot()
                assert snapshot.state == "estopped"
                assert [a.code for a in snapshot.alarms if a.first] == ["estop"]
                network.loses = lambda _: False

    asyncio.run(fly())


def test_on_a_network_that_loses_a_flight_is_flown_and_an_estop_powers_the_table_off(tmp_path: Path) -> None:
    log = tmp_path / "table.log"

    async def fly() -> None:
        with bad_network(tmp_path, "--watchdog", "1.0", "--log", str(log)) as (network, config):
            chance = random.Random(4)
            network.loses = lambda _: chance.random() < 0.2
            network.loses_state = lambda: chance.random() < 0.2
            plan = written(tmp_path / "plan", plan_of(config.rig, 6.0, swing=0.5))
            async with hosted(config) as (host, operator):
                await operator.fly(plan)
                await asyncio.sleep(1.5)
                assert host.snapshot().state == "running"
                host.estop("test")
                snapshot = await operator.until("estopped", "faulted", "disconnected")
                assert snapshot.state == "estopped", snapshot.alarms
                for _ in range(200):
                    if _table_status(log) == 0:
                        break
                    await asyncio.sleep(0.1)
                assert _table_status(log) == 0  # neither enabled nor braking: powered off
                await asyncio.sleep(0.5)
                wrong = [a.code for a in host.snapshot().alarms if a.severity != "warning"]
                assert wrong == ["estop"]
                within_limits(host.samples(0, 1 << 20)[0], host)

    asyncio.run(fly())


async def _alarm(host: RigHost, code: str) -> None:
    """Wait for an alarm."""
    for _ in range(200):
        if code in [a.code for a in host.snapshot().alarms]:
            return
        await asyncio.sleep(0.1)
    raise AssertionError(f"no alarm {code}: {host.snapshot().alarms}")


def _table_status(log: Path) -> int:
    """The newest status in the emulator's log."""
    with log.open() as file:
        rows = [line.split() for line in file if line.endswith("\n")]
    return int(rows[-1][1])


def _child_on(port: int) -> int:
    """The pid of this process's child that is bound to a UDP port."""
    for entry in Path("/proc").glob("[0-9]*/stat"):
        with contextlib.suppress(OSError):
            fields = entry.read_text().rsplit(")", 1)[1].split()
            command = entry.with_name("cmdline").read_bytes()
            if int(fields[1]) == os.getpid() and b"table_emulator" in command and fields[0] != "Z":
                return int(entry.parent.name)
    raise AssertionError(f"no emulator on port {port}")
