"""A live source: datagrams, jitter, gaps, and a real rig process that follows one."""

import asyncio
import contextlib
import math
import socket
import time
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from fullpose.attitude import dcm_from_quaternion, euler_from_ned, quaternion_from_euler, quaternion_from_ned
from fullpose_server.runtime.contract.config import LiveConfig, Tolerance
from fullpose_server.runtime.live.buffer import LiveBuffer
from fullpose_server.runtime.live.packets import (
    REPLY_SIZE,
    SAMPLE_SIZE,
    Kind,
    LiveReply,
    LiveSample,
    LiveStatus,
    decode_reply,
    decode_sample,
    encode_reply,
    encode_sample,
)
from fullpose_server.runtime.supervisor.rig_client import RigHost
from tests.fullpose_server.runtime import rigs
from tests.fullpose_server.runtime.rigs import config_of, hosted
from tests.fullpose_server.runtime.supervisor.test_rig_client import within_limits

NAN = math.nan
# The machine of the tests may starve the sender: bridge longer than on a quiet one.
PATIENT = replace(rigs.PATIENT, stale_ms=Tolerance(None, None))


def flight(t: float, swing_deg: float = 20.0) -> tuple[np.ndarray, np.ndarray]:
    """An attitude (4,) w, x, y, z and its body rate (3,) [rad/s] at time t: a smooth swing about all axes."""

    def q(at: float) -> np.ndarray:
        u = min(1.0, max(0.0, at / 2.0))
        ramp = u**3 * (10.0 - 15.0 * u + 6.0 * u * u)
        a = math.radians(swing_deg) * ramp * np.sin(2.0 * np.pi * np.array([0.3, 0.23, 0.4]) * at)
        return np.asarray(quaternion_from_euler(a[0], a[1], a[2])[0])

    h = 1e-6
    now, dq = q(t), (q(t + h) - q(t - h)) / (2.0 * h)
    w, x, y, z = now
    rate = 2.0 * np.array(
        [
            w * dq[1] - x * dq[0] - y * dq[3] + z * dq[2],
            w * dq[2] - y * dq[0] - z * dq[1] + x * dq[3],
            w * dq[3] - z * dq[0] - x * dq[2] + y * dq[1],
        ]
    )
    return now, rate


def angle_deg(a: np.ndarray, b: np.ndarray) -> float:
    return float(np.degrees(2.0 * np.arccos(min(1.0, abs(float(a @ b))))))


# --- datagrams ---


def test_every_kind_is_the_attitude_that_the_solver_reads() -> None:
    euler = (40.0, -25.0, 130.0)
    radians = np.radians(euler)
    ours = quaternion_from_euler(*radians)[0]
    ned = quaternion_from_euler(*euler_from_ned(*radians))[0]
    for kind, numbers, expected in (
        (Kind.EULER, euler, ours),
        (Kind.EULER_NED, euler, ned),
        (Kind.QUATERNION, tuple(ours), ours),
        (Kind.QUATERNION_NED, tuple(ours), quaternion_from_ned(ours[None])[0]),
    ):
        sample = decode_sample(encode_sample(kind, 3, 1.5, numbers, ()))
        assert sample is not None
        assert (sample.sequence, sample.time_s, sample.rate) == (3, 1.5, None)
        np.testing.assert_allclose(
            dcm_from_quaternion(np.array(sample.quaternion)), dcm_from_quaternion(expected), atol=1e-15
        )


def test_ned_body_rates_change_axes_with_the_attitude() -> None:
    sample = decode_sample(encode_sample(Kind.EULER_NED, 0, 0.0, (0.0, 0.0, 0.0), (10.0, 20.0, 30.0)))
    assert sample is not None
    # Forward-right-down p, q, r are ours about x, z and -y.
    np.testing.assert_allclose(np.degrees(sample.rate), [10.0, -30.0, 20.0])  # type: ignore[arg-type]


@pytest.mark.parametrize(
    "data",
    [
        b"",
        b"FPA1",
        b"\0" * SAMPLE_SIZE,
        encode_sample(Kind.QUATERNION, 0, 0.0, (NAN, 0.0, 0.0, 0.0), ()),
        encode_sample(Kind.QUATERNION, 0, 0.0, (1.0, 0.0, 0.0, NAN), ()),
        encode_sample(Kind.QUATERNION, 0, NAN, (1.0, 0.0, 0.0, 0.0), ()),
        encode_sample(Kind.QUATERNION, 0, 0.0, (0.0, 0.0, 0.0, 0.0), ()),
        encode_sample(Kind.EULER, 0, 0.0, (1.0, math.inf, 0.0), ()),
        encode_sample(9, 0, 0.0, (1.0, 0.0, 0.0, 0.0), ()),  # type: ignore[arg-type]
    ],
)
def test_what_is_no_sample_is_not_believed(data: bytes) -> None:
    assert decode_sample(data) is None


def test_replies_come_back_as_they_went() -> None:
    reply = LiveReply(int(LiveStatus.FOLLOWED), 5, 2.5, (1.0, 2.0, 3.0, 4.0), 1e-12, 0.5, 0.25, 80.0)
    assert decode_reply(encode_reply(reply)) == reply


# --- the buffer ---


def fed(
    buffer: LiveBuffer,
    rate_hz: float,
    jitter_s: float,
    seconds: float,
    rates: bool,
    skew: float = 0.0,
    delay_s: float = 0.005,
) -> list[Any]:
    """Samples at `rate_hz`, each late by up to `jitter_s`, and the worst error of what is flown at 1 kHz [deg]."""
    generator = np.random.default_rng(3)
    sent = np.arange(0.0, seconds, 1.0 / rate_hz)
    arrive = sent + 100.0 + generator.uniform(0.0, jitter_s, len(sent))
    order = np.argsort(arrive)
    errors, k = [], 0
    q = np.zeros(4)
    for now in np.arange(100.0, 100.0 + seconds, 1e-3):
        while k < len(order) and arrive[order[k]] <= now:
            i = order[k]
            attitude, rate = flight(float(sent[i]))
            stamp = float(sent[i]) * (1.0 + skew)
            a, b, c, d = attitude
            buffer.add(LiveSample(int(i), stamp, (a, b, c, d), tuple(rate) if rates else None), float(arrive[order[k]]))
            k += 1
        if buffer.at(float(now), q) and now > 101.0 + delay_s:
            errors.append((angle_deg(q, flight(float(now) - 100.0 - delay_s)[0]), buffer.age(float(now))))
    return errors


def test_jitter_within_the_delay_is_interpolated_away() -> None:
    buffer = LiveBuffer(0.005)
    errors = fed(buffer, 1000.0, 0.003, 4.0, rates=True)
    # The clock's offset is known to what the quickest datagram shows: some tens of microseconds of a turn.
    assert max(e for e, _ in errors) < 0.02
    assert max(age for _, age in errors) <= 0.0
    assert buffer.dropped > 0  # the overtaken ones


def test_a_source_that_tells_the_future_is_flown_when_it_is_due() -> None:
    # As many samples ahead as two seconds at the fastest rate hold, and three times round.
    errors = fed(LiveBuffer(2.0), 1000.0, 0.003, 8.0, rates=True, delay_s=2.0)
    assert max(e for e, _ in errors) < 0.02
    assert max(age for _, age in errors) < -1.9


def test_a_sparse_source_is_met_by_its_own_rates() -> None:
    errors = fed(LiveBuffer(0.005), 50.0, 0.0, 4.0, rates=True)
    assert max(e for e, _ in errors) < 0.05  # predicted over up to 15 ms


def test_without_rates_they_are_estimated() -> None:
    errors = fed(LiveBuffer(0.005), 250.0, 0.0, 4.0, rates=False)
    assert max(e for e, _ in errors) < 0.02


def test_a_drifting_clock_is_followed() -> None:
    errors = fed(LiveBuffer(0.005), 500.0, 0.0, 10.0, rates=True, skew=5e-5)
    assert max(e for e, _ in errors) < 0.05


def test_out_of_order_doubled_and_restarted_samples() -> None:
    buffer = LiveBuffer(0.0)
    one = (1.0, 0.0, 0.0, 0.0)
    assert buffer.add(LiveSample(5, 1.0, one, None), 100.0)
    assert not buffer.add(LiveSample(5, 1.0, one, None), 100.001)
    assert not buffer.add(LiveSample(4, 0.999, one, None), 100.001)
    assert not buffer.add(LiveSample(6, 0.9995, one, None), 100.001)
    assert buffer.dropped == 3
    # The source began anew with another clock: known as such once a few of its samples agree.
    taken = [buffer.add(LiveSample(k, 5000.0 + 0.005 * k, one, None), 100.01 + 0.005 * k) for k in range(8)]
    assert taken == [False] * 3 + [True] * 5
    assert buffer.steps == 1


@pytest.mark.parametrize("age_s", [0.001, 0.3, 1.4, 600.0])
@pytest.mark.parametrize("burst", [1, 100])
def test_samples_that_come_again_late_are_not_flown(age_s: float, burst: int) -> None:
    """Doubled on the way, one by one among the others, or all at once after a hold-up."""
    buffer = LiveBuffer(0.0)
    q = np.zeros(4)
    late = 0
    for k in range(4000):
        now = 100.0 + k * 1e-3
        a, b, c, d = flight(k * 1e-3)[0]
        buffer.add(LiveSample(10_000 + k, k * 1e-3, (a, b, c, d), None), now)
        if k % burst == 0 and k >= 2000:
            for each in range(burst):
                time_s = (k - (burst - 1 - each)) * 1e-3 - age_s
                a, b, c, d = flight(time_s)[0]
                old = LiveSample(10_000 + round(time_s * 1e3), time_s, (a, b, c, d), None)
                late += not buffer.add(old, now + 1e-5)
        buffer.at(now, q)
        assert angle_deg(q, flight(k * 1e-3)[0]) < 0.05
    assert buffer.steps == 0
    assert buffer.dropped == late > 0
    assert buffer.accepted == 4000


def test_signs_of_quaternions_do_not_matter() -> None:
    buffer = LiveBuffer(0.0)
    q = np.zeros(4)
    for i in range(20):
        attitude = flight(3.0 + i * 0.01)[0] * (-1.0) ** i
        a, b, c, d = attitude
        buffer.add(LiveSample(i, i * 0.01, (a, b, c, d), None), 100.0 + i * 0.01)
    buffer.at(100.155, q)
    assert angle_deg(q, flight(3.155)[0]) < 0.01


# --- a real rig ---


async def follow(
    host: RigHost, seconds: float, source: socket.socket, begin: int = 0, swing: float = 20.0
) -> list[LiveReply]:
    """Send the flight at 500 Hz for `seconds` and gather the replies."""
    replies: list[LiveReply] = []
    started = time.monotonic()
    sequence = begin
    while (t := time.monotonic() - started) < seconds:
        q, rate = flight(t, swing)
        source.send(encode_sample(Kind.QUATERNION, sequence, t, tuple(q), tuple(np.degrees(rate))))
        sequence += 1
        while True:
            try:
                reply = decode_reply(source.recv(REPLY_SIZE))
            except BlockingIOError:
                break
            assert reply is not None
            replies.append(reply)
        if sequence % 200 == 0:
            await host.lease("renew", "operator")
        await asyncio.sleep(0.002)
    return replies


@pytest.mark.parametrize("way", ["local", "udp"])
def test_a_source_is_followed_exactly_and_its_loss_is_a_controlled_stop(tmp_path: Path, way: str) -> None:
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]

    async def fly() -> None:
        config = config_of(tmp_path, guard=PATIENT, live=LiveConfig(udp_port=port, extrapolate_ms=500.0, delay_ms=20.0))
        async with hosted(config) as (host, operator):
            await operator.take()
            await operator.must("connect")
            await operator.must("load", live={"method": "exact"})
            refused = await operator.say("start")
            assert not refused.ok
            await operator.must("arm")
            if way == "udp":
                source = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
                source.connect(("127.0.0.1", port))
                source.setblocking(False)
            else:
                source = host.live_socket()
            with source:
                await operator.must("go_live")
                replies = await follow(host, 4.0, source)
                assert host.snapshot().state == "live", host.snapshot().alarms
                last = [r for r in replies if r.status == LiveStatus.FOLLOWED]
                assert len(last) > 500
                settled = last[len(last) // 2 :]
                assert max(r.error_deg for r in settled) <= 1e-9
                assert max(r.lag_deg for r in settled) < 3.0  # the delay, times the rate
                # Gaps of a starved sender are caught up at the acceleration limit: there none is left.
                assert all(0.0 <= r.margin <= 1.0 for r in settled)
                assert np.median([r.margin for r in settled]) > 0.1
            snapshot = await operator.until("armed", "faulted")
            assert snapshot.state == "armed", snapshot.alarms
            assert "live_source_lost" in [a.code for a in snapshot.alarms]
            rows, _ = host.samples(0, 1 << 20)
            within_limits(rows, host)

    asyncio.run(fly())


def test_nonsense_from_the_source_is_named_and_moves_nothing(tmp_path: Path) -> None:
    async def fly() -> None:
        config = config_of(tmp_path, guard=PATIENT, live=LiveConfig(extrapolate_ms=500.0, delay_ms=20.0))
        async with hosted(config) as (host, operator):
            await operator.take()
            await operator.must("connect")
            for settings, word in (({"method": "magic"}, "magic"), ({"method": "lagrange"}, "limits")):
                reply = await operator.say("load", live=settings)
                assert reply.error is not None
                assert word in reply.error.message
            await operator.must("load", live={})
            await operator.must("arm")
            with host.live_socket() as source:
                await operator.must("go_live")
                for data in (b"junk", encode_sample(Kind.QUATERNION, 0, 0.0, (NAN, 0.0, 0.0, 0.0), ())):
                    source.send(data)
                await asyncio.sleep(0.2)
                newest = host.latest()
                assert newest is not None
                assert np.abs(newest["demand_rate"]).max() == 0.0
                # A jump of the attitude by 90 deg: approached inside the limits, not refused and not jumped to.
                far = quaternion_from_euler(math.radians(90.0), 0.0, 0.0)[0]
                begun = time.monotonic()
                sequence = 1
                while (t := time.monotonic() - begun) < 4.0:
                    source.send(encode_sample(Kind.QUATERNION, sequence, t, tuple(far), (0.0, 0.0, 0.0)))
                    sequence += 1
                    if sequence % 200 == 0:
                        await host.lease("renew", operator.who)
                    await asyncio.sleep(0.002)
                assert host.snapshot().state == "live", host.snapshot().alarms
                newest = host.latest()
                assert newest is not None
                assert newest["solve_error_deg"][0] <= 1e-9
                assert "live_bad" in [a.code for a in host.snapshot().alarms]
            await operator.until("armed")
            within_limits(host.samples(0, 1 << 20)[0], host)

    asyncio.run(fly())


def test_a_second_source_is_not_followed(tmp_path: Path) -> None:
    async def fly() -> None:
        config = config_of(tmp_path, guard=PATIENT, live=LiveConfig(extrapolate_ms=500.0, delay_ms=20.0))
        async with hosted(config) as (host, operator):
            await operator.arm_live()
            with host.live_socket() as source, host.live_socket() as second:
                await operator.must("go_live")
                replies = await follow(host, 1.0, source)
                over = asyncio.Event()

                async def disturb() -> list[int]:
                    found, begun, sequence = [], time.monotonic(), 0
                    while not over.is_set():
                        told = time.monotonic() - begun + 1000.0
                        second.send(encode_sample(Kind.QUATERNION, sequence, told, (0.0, 1.0, 0.0, 0.0), ()))
                        sequence += 1
                        await asyncio.sleep(0.002)
                        with contextlib.suppress(BlockingIOError):
                            reply = decode_reply(second.recv(REPLY_SIZE))
                            assert reply is not None
                            found.append(reply.status & (LiveStatus.FOLLOWED | LiveStatus.DROPPED))
                    return found

                disturbing = asyncio.create_task(disturb())
                replies = await follow(host, 2.0, source, begin=len(replies) + 10_000)
                over.set()
                answered = await disturbing
                snapshot = host.snapshot()
                assert snapshot.state == "live", snapshot.alarms
                assert "live_second_source" in [a.code for a in snapshot.alarms]
                assert set(answered) == {LiveStatus.DROPPED}
                later = replies[len(replies) // 2 :]  # it was regained by then; a starved machine answers fewer
                settled = [r for r in later if r.status == LiveStatus.FOLLOWED]
                assert len(settled) > len(later) / 4
                assert max(r.lag_deg for r in settled) < 5.0
            await operator.until("armed")

    asyncio.run(fly())


def test_a_source_that_jumps_is_regained_inside_the_limits_and_no_fault(tmp_path: Path) -> None:
    async def fly() -> None:
        config = config_of(tmp_path, guard=PATIENT, live=LiveConfig(extrapolate_ms=500.0, delay_ms=20.0))
        async with hosted(config) as (host, operator):
            await operator.arm_live()
            with host.live_socket() as source:
                await operator.must("go_live")
                begun = time.monotonic()
                sequence = 0
                while (t := time.monotonic() - begun) < 5.0:
                    # Reached by 2 s; from then on 40 deg elsewhere, as after a gap in which nobody saw it turn.
                    there = quaternion_from_euler(math.radians(10.0 if t < 2.0 else 50.0), 0.0, 0.0)[0]
                    source.send(encode_sample(Kind.QUATERNION, sequence, t, tuple(there), (0.0, 0.0, 0.0)))
                    sequence += 1
                    if sequence % 200 == 0:
                        await host.lease("renew", operator.who)
                    await asyncio.sleep(0.002)
                snapshot = host.snapshot()
                assert snapshot.state == "live", snapshot.alarms
                (said,) = [alarm for alarm in snapshot.alarms if alarm.code == "attitude_error"]
                assert said.severity == "warning"
                newest = host.latest()
                assert newest is not None
                assert newest["solve_error_deg"][0] <= 1e-9  # regained
            await operator.until("armed")
            rows, _ = host.samples(0, 1 << 20)
            within_limits(rows, host)
            assert np.nanmax(rows["solve_error_deg"]) > 30.0

    asyncio.run(fly())
