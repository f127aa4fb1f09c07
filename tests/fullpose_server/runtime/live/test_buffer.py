"""The buffer of a live source: jitter, gaps, clocks that drift or begin anew, samples that come late or twice."""

from typing import Any

import numpy as np
import pytest

from fullpose_server.runtime.live.buffer import LiveBuffer
from fullpose_server.runtime.live.packets import LiveSample
from tests.fullpose_server.runtime.live.swing import angle_deg, flight


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


def test_the_rate_of_a_sample_is_the_greater_of_what_it_says_and_what_it_takes() -> None:
    buffer = LiveBuffer(0.0)
    level, turned = (1.0, 0.0, 0.0, 0.0), (np.cos(0.05), np.sin(0.05), 0.0, 0.0)  # by 0.1 rad
    assert buffer.rate_of(LiveSample(0, 0.0, turned, None)) == 0.0
    buffer.add(LiveSample(0, 0.0, level, None), 100.0)
    assert buffer.rate_of(LiveSample(1, 0.1, turned, None)) == pytest.approx((0.1 - np.radians(0.1)) / 0.1)
    assert buffer.rate_of(LiveSample(1, 0.1, turned, (3.0, 0.0, 4.0))) == 5.0
    opposite = tuple(-v for v in turned)
    assert buffer.rate_of(LiveSample(1, 0.1, opposite, None)) < 1.0  # the same attitude
    assert buffer.rate_of(LiveSample(1, 1e-6, (1.0, 5e-4, 0.0, 0.0), None)) == 0.0  # noise, however close they come
    assert buffer.rate_of(LiveSample(1, 0.0, turned, None)) == 0.0  # no next one
