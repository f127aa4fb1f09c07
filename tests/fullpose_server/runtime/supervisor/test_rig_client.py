"""A whole rig process, really running at 1 kHz on the simulated drive, through `RigHost`."""

import asyncio
from pathlib import Path

import numpy as np
import pytest
from mcap.reader import make_reader

from fullpose_server.runtime.supervisor.errors import RefusedError
from fullpose_server.runtime.supervisor.rig_client import RigHost
from fullpose_server.session.states import STATES
from tests.fullpose_server.runtime.rigs import Operator, config_of, hosted, plan_of, ticked, within_limits, written
from tests.support.waiting import soon

FLIGHT = ("running", "held")


def test_a_flight_of_ten_seconds_is_flown_recorded_and_nothing_is_lost(tmp_path: Path) -> None:
    async def fly() -> None:
        config = config_of(tmp_path)
        plan = plan_of(config.rig, 10.0)
        async with hosted(config) as (host, operator):
            await operator.arm(written(tmp_path / "plan", plan))
            latest = host.latest()
            assert latest is not None
            since = int(latest["seq"][0])
            await operator.must("start")
            await operator.until("running")
            await operator.until("armed", "faulted")
            await soon(lambda: host.snapshot().health.recorder.run == "")  # the record is complete
            rows, lost = host.samples(since, 1 << 20)
            snapshot = host.snapshot()
            assert snapshot.state == "armed", snapshot.alarms
            assert lost == 0
            within_limits(rows, host)
            flown = rows[np.isfinite(rows["solve_error_deg"])]
            assert len(flown) == plan.info.samples - plan.info.lead_in_samples - plan.info.lead_out_samples
            assert flown["solve_error_deg"].max() <= 1e-9
            tracking = flown["tracking_error_deg"][1:]
            assert 0.0 < np.nanmedian(tracking) < 0.5  # the servos', not the solver's; of a starved tick it is more
            assert snapshot.health.recorder.lost == 0
            assert snapshot.health.recorder.error == ""
        (record,) = (tmp_path / "runs").iterdir()
        with record.open("rb") as file:
            reader = make_reader(file)
            telemetry = [m for _, channel, m in reader.iter_messages() if channel.topic == "/telemetry"]
        numbers = np.array([m.sequence for m in telemetry])
        assert (np.diff(numbers) == 1).all()
        running = rows["seq"][rows["state"] == STATES.index("running")].tolist()
        assert set(running) <= set(numbers.tolist())

    asyncio.run(fly())


def test_hold_resume_stop_estop_reset(tmp_path: Path) -> None:
    async def fly() -> None:
        config = config_of(tmp_path)
        plan = written(tmp_path / "plan", plan_of(config.rig, 6.0))
        async with hosted(config) as (host, operator):
            await operator.fly(plan)
            await ticked(host, 2.0)
            await operator.must("hold")
            await soon(lambda: (newest := host.latest()) is not None and not newest["demand_rate"].any())
            held = host.latest()
            assert held is not None
            assert held["path_scale"][0] == 0.0
            assert np.abs(held["demand_rate"]).max() == 0.0
            await operator.must("resume")
            await ticked(host, 1.0)
            reply = await host.stop("somebody without a lease")
            assert reply.ok
            await operator.until("armed")
            rows, _ = host.samples(0, 1 << 20)
            within_limits(rows, host)
            flown = rows[np.isfinite(rows["solve_error_deg"])]
            assert flown["solve_error_deg"].max() <= 1e-9

            await operator.must("start")
            await operator.until("running")
            await ticked(host, 1.5)
            host.estop("somebody")
            snapshot = await operator.until("estopped")
            latched = [a for a in snapshot.alarms if a.severity != "warning"]  # a starved machine may warn of lateness
            assert [(a.code, a.first) for a in latched] == [("estop", True)]
            refused = await operator.say("start")
            assert refused.error is not None
            assert refused.error.code == "illegal_command"
            assert (refused.error.state, refused.error.command) == ("estopped", "start")
            assert "reset" in refused.error.allowed
            unseen = await operator.at_rest("reset")
            assert unseen.error is not None
            assert unseen.error.code == "unacknowledged"
            await operator.recover()
            assert host.snapshot().state == "idle"
            newest = host.latest()
            assert newest is not None
            assert not newest["flags"][0] & 8  # the drive is off
            within_limits(host.samples(0, 1 << 20)[0], host)

    asyncio.run(fly())


def test_move_home_and_jog(tmp_path: Path) -> None:
    async def move() -> None:
        config = config_of(tmp_path)
        plan = written(tmp_path / "plan", plan_of(config.rig, 1.0))
        async with hosted(config) as (host, operator):
            await operator.arm(plan)
            await operator.must("move", target_deg=[10.0, -20.0, 15.0, 5.0])
            await operator.until("armed")
            newest = host.latest()
            assert newest is not None
            np.testing.assert_allclose(newest["measured"][0], [10.0, -20.0, 15.0, 5.0], atol=0.01)
            await operator.must("jog", frame="inner", step_deg=-2.0)
            await operator.until("armed")
            too_far = await operator.say("move", target_deg=[0.0, 0.0, 0.0, 61.0])
            assert too_far.error is not None
            assert too_far.error.code == "outside_limits"
            assert "inner" in too_far.error.message
            await operator.must("home")
            snapshot = await operator.until("armed")
            np.testing.assert_allclose(snapshot.pose_deg, 0.0, atol=0.01)
            within_limits(host.samples(0, 1 << 20)[0], host)

    asyncio.run(move())


def test_the_lease_is_one_operator_s(tmp_path: Path) -> None:
    async def two() -> None:
        async with hosted(config_of(tmp_path)) as (host, first):
            second = Operator(host, "second")
            refused = await second.say("connect")
            assert refused.error is not None
            assert refused.error.code == "lease_needed"
            await first.take()
            with pytest.raises(RefusedError, match="operator holds the lease"):
                await second.take()
            await first.must("connect")
            again = await host.command("load", {}, "operator", None)
            assert again.error is not None
            first.sequence = 0  # the same sequence once more: sent twice
            doubled = await first.say("load", plan_folder="/nowhere")
            assert doubled.error is not None
            assert doubled.error.code == "stale_command"
            await second.take("takeover")
            late = await first.say("load", plan_folder="/nowhere")
            assert late.error is not None
            assert late.error.code == "lease_lost"
            missing = await second.say("load", plan_folder="/nowhere")
            assert missing.error is not None
            assert missing.error.code == "bad_plan"
            assert "/nowhere" in missing.error.message

    asyncio.run(two())


def test_a_plan_of_another_rig_is_refused(tmp_path: Path) -> None:
    async def load() -> None:
        from fullpose.rig import builtin_rigs

        other = written(tmp_path / "plan", plan_of(builtin_rigs()["vertical-4"], 1.0))
        async with hosted(config_of(tmp_path)) as (_, operator):
            await operator.take()
            await operator.must("connect")
            reply = await operator.say("load", plan_folder=str(other))
            assert reply.error is not None
            assert reply.error.code == "wrong_pair"
            assert reply.state_after == "idle"

    asyncio.run(load())


def test_a_link_that_the_process_drops_is_opened_anew(tmp_path: Path) -> None:
    async def fly() -> None:
        async with hosted(config_of(tmp_path)) as (host, operator):
            await operator.take()
            link = await host._link.current()
            link._socket.send(b"no request")  # dropped for it, as is who does not read its answers
            await soon(lambda: not link.open_for_requests)
            await operator.must("connect")
            assert await host._link.current() is not link
            assert host.snapshot().state == "idle"

    asyncio.run(fly())


async def at_rest(host: RigHost, operator: Operator) -> None:
    """Wait until the session takes commands of an armed rig again."""
    snapshot = await operator.until("armed", "faulted")
    assert snapshot.state == "armed", snapshot.alarms


def test_a_rig_that_rests_on_a_limit_is_armed_again(tmp_path: Path) -> None:
    async def fly() -> None:
        config = config_of(tmp_path)
        async with hosted(config) as (host, operator):
            await operator.arm(written(tmp_path / "plan", plan_of(config.rig, 0.5)))
            for target in (60.0, -60.0):
                await operator.must("move", target_deg=[0.0, 0.0, 0.0, target])
                await at_rest(host, operator)
                await operator.must("disarm")
                await operator.must("arm")
                await ticked(host, 0.2)
                assert host.snapshot().state == "armed", host.snapshot().alarms

    asyncio.run(fly())


def test_a_frame_found_outside_its_range_is_told_and_may_come_back(tmp_path: Path) -> None:
    async def fly() -> None:
        config = config_of(tmp_path, drive_options={"start_deg": [0.0, 0.0, 0.0, 61.0]})
        async with hosted(config) as (host, operator):
            await operator.arm(written(tmp_path / "plan", plan_of(config.rig, 0.5)))
            await ticked(host, 0.2)
            snapshot = host.snapshot()
            assert snapshot.state == "armed", snapshot.alarms
            (told,) = [a for a in snapshot.alarms if a.code == "outside_range"]
            assert (told.frame, told.severity) == ("inner", "warning")
            farther = await operator.say("jog", frame="inner", step_deg=0.5)
            assert farther.error is not None
            assert farther.error.code == "outside_limits"
            await operator.must("jog", frame="base", step_deg=1.0)
            await at_rest(host, operator)
            await operator.must("home")
            await at_rest(host, operator)
            np.testing.assert_allclose(host.snapshot().pose_deg, 0.0, atol=0.01)
            within_limits(host.samples(0, 1 << 20)[0], host)

    asyncio.run(fly())


def test_a_frame_outside_its_range_follows_no_live_source(tmp_path: Path) -> None:
    async def fly() -> None:
        config = config_of(tmp_path, drive_options={"start_deg": [0.0, 0.0, 0.0, 61.0]})
        async with hosted(config) as (host, operator):
            await operator.arm_live()
            refused = await operator.say("go_live")
            assert refused.error is not None
            assert refused.error.code == "outside_limits"
            assert "inner stands at 61 deg" in refused.error.message
            assert host.snapshot().state == "armed"

    asyncio.run(fly())


def test_a_move_that_would_take_hours_is_refused_and_the_rig_lives(tmp_path: Path) -> None:
    async def fly() -> None:
        config = config_of(tmp_path)
        async with hosted(config) as (host, operator):
            await operator.arm(written(tmp_path / "plan", plan_of(config.rig, 0.5)))
            pid = host.snapshot().health.rig_pid
            refused = await operator.say("move", target_deg=[5e6, 0.0, 0.0, 0.0])
            assert refused.error is not None
            assert refused.error.code == "outside_limits"
            assert "base" in refused.error.message
            assert (host.snapshot().state, host.snapshot().health.rig_pid) == ("armed", pid)

    asyncio.run(fly())


def test_a_process_that_ran_by_other_settings_is_replaced_or_told_as_it_is(tmp_path: Path) -> None:
    async def fly() -> None:
        first = RigHost(config_of(tmp_path))
        await first.start()
        operator = Operator(first)
        await operator.take()
        pid = first.snapshot().health.rig_pid
        await first.close(stop_rig=False)

        other = RigHost(config_of(tmp_path, rate_hz=500.0))
        await other.start()
        assert not other.adopted
        assert other.rate_hz == 500.0
        assert other.snapshot().health.rig_pid != pid
        again = Operator(other)
        await again.arm(written(tmp_path / "plan", plan_of(other.rig, 0.5, rate_hz=500.0)))
        pid = other.snapshot().health.rig_pid
        await other.close(stop_rig=False)

        last = RigHost(config_of(tmp_path))
        await last.start()
        try:
            assert last.adopted
            snapshot = last.snapshot()
            assert (snapshot.state, snapshot.health.rig_pid) == ("armed", pid)
            assert snapshot.health.rate_hz == 500.0  # what runs, not what the settings say by now
        finally:
            await last.close(stop_rig=True)

    asyncio.run(fly())
