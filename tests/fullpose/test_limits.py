"""The box of one sample: never empty, however rough the ride and however the samples are spaced."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from fullpose.bounds import limited_name
from fullpose.limits import approach_rate, empty_box, inside, limit_box, limit_table, tolerances
from fullpose.rig import FrameLimits, Geometry, Rig, builtin_rigs
from fullpose.verify import verify


def ride(rig: Rig, steps: NDArray[np.float64], pull: NDArray[np.float64]) -> tuple[NDArray[np.float64], float]:
    """Angles of a flight that goes wherever in its box `pull` (n, 4) in [0, 1] says, and the narrowest box met."""
    table = limit_table(rig)
    x = [rig.home.copy()]
    v, past = np.zeros(4), 0.0
    box = empty_box()
    narrowest = np.inf
    for h, share in zip(steps, pull, strict=True):
        limit_box(table, x[-1], v, past, h, box)
        width = box.hi - box.lo
        narrowest = min(narrowest, float((width / h)[list(rig.geometry.frames)].min()))
        following = np.where(share == 1.0, box.hi, box.lo + share * width)
        v, past = (following - x[-1]) / h, h
        x.append(following)
    return np.array(x), narrowest


def one_frame(span: float, rate: float, acceleration: float) -> Rig:
    frame = FrameLimits(-span, span, rate, acceleration)
    return Rig("test", Geometry.VERTICAL_4, (frame, frame, frame, frame))


@settings(max_examples=200)
@given(
    span=st.floats(0.01, 10.0),
    rate=st.floats(0.1, 20.0),
    acceleration=st.floats(0.1, 100.0),
    seed=st.integers(0, 2**32 - 1),
    uneven=st.floats(0.0, 1.5),
    greed=st.sampled_from([0.0, 0.5, 0.9, 1.0]),
)
def test_limits_are_never_exceeded_and_the_box_is_never_empty(
    span: float, rate: float, acceleration: float, seed: int, uneven: float, greed: float
) -> None:
    """Frames thrown at their stops at full rate, sample spacings spread over orders of magnitude."""
    random = np.random.default_rng(seed)
    # 0.1 ms to 1 s: below that, the differences of double precision angles no longer resolve an acceleration.
    time = np.cumsum(np.clip(0.01 * np.exp(uneven * random.normal(size=301)), 1e-4, 1.0))
    # Long pulls one way, so that full rate is reached at the stop; some samples at random in between.
    pull = np.repeat(random.integers(0, 2, (15, 4)), 20, axis=0).astype(float)
    pull = np.where(random.random((300, 4)) < greed, pull, random.random((300, 4)))
    rig = one_frame(span, rate, acceleration)
    angles, narrowest = ride(rig, np.diff(time), pull)
    assert narrowest >= 0.0
    assert np.abs(angles).max() <= span
    verification = verify(time, angles, rig)
    assert verification.violations == ()


def test_the_whole_range_is_used() -> None:
    """The braking distance does not cost the range: pulled one way, a frame reaches its stop and stands on it."""
    rig = one_frame(1.0, 2.0, 5.0)
    angles, _ = ride(rig, np.full(20_000, 1e-3), np.ones((20_000, 4)))
    np.testing.assert_allclose(angles[-1], 1.0, atol=1e-6)
    # It got there no slower than by full acceleration, full rate, full braking, but for the braking's reserve.
    arrival = int(np.argmax(angles[:, 0] > 0.999)) * 1e-3
    assert arrival < 1.0 / 2.0 + 2.0 / 5.0 + 0.05


def test_codes_name_the_limit_that_sets_the_bound() -> None:
    rig = one_frame(1.0, 2.0, 5.0)
    box = empty_box()
    d = np.array([0.0, 0.0, 0.9999, -0.9999])
    v = np.array([0.0, 1.9999, 0.0, 0.0])
    limit_box(limit_table(rig), d, v, 1e-3, 1e-3, box)
    assert limited_name(int(box.hi_code[0])) == ("base", "acceleration")
    assert limited_name(int(box.lo_code[0])) == ("base", "acceleration")
    assert limited_name(int(box.hi_code[1])) == ("outer", "rate")
    assert limited_name(int(box.lo_code[1])) == ("outer", "acceleration")
    d[2] = 1.0
    limit_box(limit_table(rig), d, v, 1e-3, 1e-3, box)
    assert limited_name(int(box.hi_code[2])) == ("middle", "position")
    assert 1.0 - 1e-9 < box.hi[2] < 1.0


def test_without_limits_the_box_is_all_there_is() -> None:
    box = empty_box()
    limit_box(limit_table(Rig("free", Geometry.VERTICAL_4)), np.zeros(4), np.zeros(4), 0.0, 1e-3, box)
    assert np.isneginf(box.lo).all()
    assert np.isposinf(box.hi).all()


@given(room=st.floats(0.0, 10.0), deceleration=st.floats(0.1, 100.0), h=st.floats(1e-4, 1.0))
def test_approach_rate_leaves_room_to_brake(room: float, deceleration: float, h: float) -> None:
    """Brake as hard as allowed, sample after sample: the stop is met, not passed."""
    v = approach_rate(room, deceleration, h)
    left = room - v * h
    while v > 0.0 and left > -1.0:
        v = max(0.0, v - deceleration * h)
        left -= v * h
    assert left >= -1e-10 * max(1.0, room)  # tens of thousands of roundings


@pytest.mark.parametrize("bad", [np.nan, 1.1, -0.1])
def test_inside(bad: float) -> None:
    lo, hi, tolerance = np.zeros(4), np.ones(4), np.full(4, 1e-3)
    x = np.full(4, 0.5)
    assert inside(x, lo, hi, tolerance)
    x[3] = bad
    assert not inside(x, lo, hi, tolerance)
    x[3] = 1.0005
    assert inside(x, lo, hi, tolerance)


def test_tolerance_is_far_below_what_the_check_allows() -> None:
    rig = builtin_rigs()["vertical-4"]
    out = np.empty(4)
    tolerances(limit_table(rig), 1e-3, 1e-3, out)
    assert np.all(out / 1e-6 <= 0.1 * 1e-6 * rig.max_acceleration)
