"""A live source flown by the whole loop on a made-up clock: followed exactly, lost, jumping, disturbed."""

import dataclasses
import math
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest

from fullpose.attitude import quaternion_from_euler
from fullpose.rig import builtin_rigs
from fullpose_server.runtime.contract.config import LiveConfig, RigConfig
from fullpose_server.runtime.live.packets import Kind, LiveReply, LiveStatus, decode_reply, encode_sample
from fullpose_server.runtime.live.provenance import digest_of
from fullpose_server.session.states import State
from tests.fullpose_server.runtime.live.swing import flight
from tests.fullpose_server.runtime.rigs import within_limits
from tests.support.made_up_rig import LIVE_KEY, MadeUpRig, made_up_rig

RIG = builtin_rigs()["vertical-limited"]


@pytest.fixture
def rig(tmp_path: Path) -> Iterator[MadeUpRig]:
    config = RigConfig("test", RIG, tmp_path / "rig", tmp_path / "runs", min_free_mb=0.0)
    with made_up_rig(dataclasses.replace(config, live=LiveConfig(delay_ms=5.0))) as made:
        yield made


def live(rig: MadeUpRig, source: str = "exact") -> None:
    """From its beginning to live."""
    rig.ready(live={"method": source})
    rig.must("arm")
    rig.run(0.05)
    rig.must("go_live")


def swing(k: int, t: float) -> bytes:
    """The sample of the swing at time t."""
    q, rate = flight(t)
    return encode_sample(Kind.QUATERNION, k, t, tuple(q), tuple(np.degrees(rate)))


def turned(k: int, t: float, yaw_deg: float) -> bytes:
    """A sample that stands still, turned by `yaw_deg`."""
    q = quaternion_from_euler(math.radians(yaw_deg), 0.0, 0.0)[0]
    return encode_sample(Kind.QUATERNION, k, t, tuple(q), (0.0, 0.0, 0.0))


def replies(rig: MadeUpRig, to: str = "source") -> list[LiveReply]:
    found = [decode_reply(data) for data, receiver in rig.link.replies if receiver == to]
    assert None not in found
    return [reply for reply in found if reply is not None]


def newest(rig: MadeUpRig) -> np.ndarray:
    row = rig.shared.ring.latest()
    assert row is not None
    return row[0]


def test_a_source_is_followed_exactly_and_its_loss_is_a_controlled_stop(rig: MadeUpRig) -> None:
    rig.source = swing
    live(rig)
    rig.run(4.0)
    assert rig.state is State.LIVE, rig.codes()
    settled = replies(rig)[-3500:]
    assert len(settled) == 3500
    assert {reply.status for reply in settled} == {LiveStatus.FOLLOWED}
    assert max(reply.error_deg for reply in settled) <= 1e-9
    assert max(reply.lag_deg for reply in settled) < 1.0  # the delay and a tick, times the rate
    assert all(0.0 < reply.margin <= 1.0 for reply in settled)
    rig.source_heard = False
    rig.until(State.ARMED)
    assert rig.codes() == ["live_source_stale", "live_source_lost"]
    within_limits(rig.rows(), rig)


def test_a_plan_is_not_started_where_a_source_is_loaded(rig: MadeUpRig) -> None:
    rig.ready(live={"method": "exact"})
    rig.must("arm")
    rig.run(0.05)
    refused = rig.say("start")
    assert refused.error is not None
    assert refused.error.code == "wrong_load"


@pytest.mark.parametrize(("method", "word"), [("magic", "magic"), ("lagrange", "limits")])
def test_a_method_that_cannot_fly_live_is_refused_by_name(rig: MadeUpRig, method: str, word: str) -> None:
    rig.take()
    rig.tick()
    rig.must("connect")
    reply = rig.say("load", live={"method": method})
    assert reply.error is not None
    assert word in reply.error.message


def test_nonsense_is_named_and_moves_nothing(rig: MadeUpRig) -> None:
    live(rig)
    nan = encode_sample(Kind.QUATERNION, 0, 0.0, (math.nan, 0.0, 0.0, 0.0), ())
    rig.source = lambda k, _: (b"junk", nan)[k % 2]
    rig.run(0.2)
    assert np.abs(newest(rig)["demand_rate"]).max() == 0.0
    assert "live_bad" in rig.codes()


def test_a_source_far_away_is_approached_inside_the_limits(rig: MadeUpRig) -> None:
    rig.source = lambda k, t: turned(k, t, 90.0)
    live(rig)
    rig.run(4.0)
    assert rig.state is State.LIVE, rig.codes()
    assert newest(rig)["solve_error_deg"] <= 1e-9
    assert replies(rig)[50].status & LiveStatus.LIMITED
    within_limits(rig.rows(), rig)


def test_a_source_that_jumps_is_regained_inside_the_limits_and_no_fault(rig: MadeUpRig) -> None:
    # Reached by 2 s; from then on 40 deg elsewhere, as after a gap in which nobody saw it turn.
    rig.source = lambda k, t: turned(k, t, 10.0 if t < 2.0 else 50.0)
    live(rig)
    rig.run(5.0)
    assert rig.state is State.LIVE, rig.codes()
    (said,) = [alarm for alarm in rig.parts.machine.alarms.standing if alarm.code == "attitude_error"]
    assert said.severity == "warning"
    assert newest(rig)["solve_error_deg"] <= 1e-9
    rows = rig.rows()
    assert np.nanmax(rows["solve_error_deg"]) > 30.0
    within_limits(rows, rig)


def test_a_second_source_is_not_followed(rig: MadeUpRig) -> None:
    rig.source = swing
    live(rig)
    rig.run(1.0)
    for k in range(2000):
        other = encode_sample(Kind.QUATERNION, k, 1000.0 + k * 1e-3, (0.0, 1.0, 0.0, 0.0), ())
        rig.link.waiting.append((other + digest_of(LIVE_KEY), "second"))
        rig.tick()
    assert rig.state is State.LIVE, rig.codes()
    assert rig.codes() == ["live_second_source"]
    assert {reply.status for reply in replies(rig, "second")} == {LiveStatus.DROPPED}
    settled = replies(rig)[-2000:]
    assert {reply.status for reply in settled} == {LiveStatus.FOLLOWED}
    assert max(reply.lag_deg for reply in settled) < 1.0


def test_one_implausible_sample_is_refused_and_told_and_the_flight_goes_on(rig: MadeUpRig) -> None:
    limit = math.degrees(float(RIG.max_rate.sum()))

    def source(k: int, t: float) -> bytes:
        if k == 1000:  # a jump, as of a broken packet
            return turned(k, t, 179.0)
        if k == 1500:  # a rate that nothing has
            q, _ = flight(t)
            return encode_sample(Kind.QUATERNION, k, t, tuple(q), (0.0, 1e6, 0.0))
        return swing(k, t)

    rig.source = source
    live(rig)
    rig.run(3.0)
    assert rig.state is State.LIVE, rig.codes()
    assert rig.codes() == ["live_implausible_rate"]
    (alarm,) = rig.parts.machine.alarms.standing
    assert (alarm.severity, alarm.unit, alarm.limit, alarm.count) == ("warning", "deg/s", pytest.approx(limit), 1)
    refused = [reply for reply in replies(rig) if reply.status & LiveStatus.IMPLAUSIBLE]
    assert [(reply.sequence, reply.status) for reply in refused] == [(k, LiveStatus.IMPLAUSIBLE) for k in (1000, 1500)]
    assert refused[0].value > 1e5
    assert refused[1].value == pytest.approx(1e6)
    assert [reply.limit for reply in refused] == [pytest.approx(limit)] * 2
    assert all(math.isnan(reply.value) and math.isnan(reply.limit) for reply in replies(rig) if reply not in refused)
    health = rig.parts.live.health()
    assert health is not None
    assert health.implausible == 2
    rows = rig.rows()
    assert np.nanmax(rows["solve_error_deg"][-1500:]) <= 1e-9
    within_limits(rows, rig)


def test_a_source_that_is_implausible_for_long_is_lost_and_stops_the_rig_without_a_jump(rig: MadeUpRig) -> None:
    rig.source = lambda k, t: swing(k, t) if t < 1.0 else turned(k, t, 179.0)
    live(rig)
    rig.until(State.ARMED, within_s=5.0)
    codes = rig.codes()
    assert codes[0] == "live_implausible_rate"
    assert "live_source_lost" in codes
    assert rig.state is State.ARMED
    within_limits(rig.rows(), rig)


def test_who_sends_first_and_is_not_the_source_that_was_loaded_is_not_followed(rig: MadeUpRig) -> None:
    rig.source_heard = False
    live(rig)
    sent = (turned(0, 0.0, 60.0), turned(1, 0.1, 60.0) + digest_of("another key"), turned(2, 0.2, 60.0)[:-1])
    for k in range(300):
        rig.link.waiting.append((sent[k % 3], "stranger"))
        rig.tick()
    assert rig.state is State.LIVE, rig.codes()
    assert np.abs(rig.rows()["demand_rate"]).max() == 0.0
    assert sorted(rig.codes()) == ["live_bad", "live_unproven"]
    assert {reply.status for reply in replies(rig, "stranger")} == {LiveStatus.UNPROVEN}
    rig.source_heard, rig.source = True, swing
    rig.run(1.0)
    assert {reply.status for reply in replies(rig)[-500:]} == {LiveStatus.FOLLOWED}
    health = rig.parts.live.health()
    assert health is not None
    assert (health.unproven, health.bad) == (200, 100)
