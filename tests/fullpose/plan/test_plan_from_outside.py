"""The planner from outside: every plan is checked by differences of what it wrote and by SciPy's rotations."""

import math
from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from fullpose._typing import Array
from fullpose.plan import Plan, plan
from fullpose.rig import FrameLimits, Geometry, Rig, builtin_rigs
from fullpose.scenarios import random_flight

DEG = math.pi / 180.0
ORDER = {Geometry.VERTICAL_4: "YZYX", Geometry.HORIZONTAL_4: "ZYZX"}


def from_euler(yaw: Array, pitch: Array, roll: Array) -> Array:
    """Body from reference (n, 3, 3), by SciPy."""
    return Rotation.from_euler("YZX", np.stack(np.broadcast_arrays(yaw, pitch, roll), axis=-1)).inv().as_matrix()


def payload(rig: Rig, angles: Array) -> Array:
    """Body from reference by SciPy: the active turns about the frames' own axes, from the outside in."""
    turn = Rotation.identity()
    for column, axis in enumerate(ORDER[rig.geometry]):
        turn = turn * Rotation.from_euler(axis, angles[:, column : column + 1])
    return turn.inv().as_matrix()


def assert_flown(result: Plan, rig: Rig, time: Array, attitude: Array) -> None:
    """Exact at every sample and inside every limit, lead-in and lead-out included."""
    assert result.verdict.feasible, result.verdict
    angles = result.solution.angles
    assert np.abs(payload(rig, angles) - attitude).max() <= 1e-14
    assert not result.solution.limited_samples
    whole, times = angles, time
    if len(time) > 1:
        whole = np.vstack([result.lead_in, angles, result.lead_out])
        before, after = len(result.lead_in), len(result.lead_out)
        step, last = time[1] - time[0], time[-1] - time[-2]
        times = np.concatenate(
            [time[0] + step * np.arange(-before, 0), time, time[-1] + last * np.arange(1, after + 1)]
        )
    assert (whole >= rig.position_min - 1e-9).all()
    assert (whole <= rig.position_max + 1e-9).all()
    if len(times) > 1:
        gaps = np.diff(times)[:, None]
        rates = np.diff(whole, axis=0) / gaps
        assert (np.abs(rates) <= rig.max_rate * (1 + 1e-6)).all()
        accelerations = np.diff(rates, axis=0) / ((gaps[1:] + gaps[:-1]) / 2)
        assert (np.abs(accelerations) <= rig.max_acceleration * (1 + 1e-6)).all()


def limited(geometry: Geometry, **frames: FrameLimits) -> Rig:
    """The built-in limits of a geometry, with some frames replaced."""
    names = ("base", "outer", "middle", "inner")
    base = builtin_rigs()[geometry.value].frames
    return Rig("test", geometry, tuple(frames.get(name, base[i]) for i, name in enumerate(names)))  # type: ignore[arg-type]


def span(frame: FrameLimits, low: float, high: float) -> FrameLimits:
    """The frame with a range [deg]."""
    return replace(frame, min=low * DEG, max=high * DEG)


@pytest.mark.parametrize("geometry", [Geometry.VERTICAL_4, Geometry.HORIZONTAL_4])
@pytest.mark.parametrize("rate", [60.0, 120.0])
def test_random_flights_past_the_inner_limit(geometry: Geometry, rate: float) -> None:
    base = builtin_rigs()[geometry.value].frames
    rig = limited(geometry, inner=span(base[3], -60, 60))
    for seed in (11, 12):
        time, q = random_flight(seed, 10.0, 500.0, rate * DEG)
        attitude = Rotation.from_quat(q[:, [1, 2, 3, 0]]).inv().as_matrix()
        assert_flown(plan(time, attitude, rig), rig, time, attitude)


def test_double_loop_with_half_rolls_stays_slow() -> None:
    # mathematics, section 8: pitch through 720 deg with three half rolls plans with a peak of about 90 deg/s.
    time = np.arange(0.0, 20.0, 2e-3)
    s = time / time[-1]
    smooth = s - np.sin(2 * np.pi * s) / (2 * np.pi)
    attitude = from_euler(0.0 * s, 4 * np.pi * smooth, 3 * np.pi * smooth)
    rig = builtin_rigs()["vertical-limited"]
    result = plan(time, attitude, rig)
    assert_flown(result, rig, time, attitude)
    assert np.abs(np.diff(result.solution.angles, axis=0) / 2e-3).max() < 130 * DEG


def test_several_turns_keep_their_count() -> None:
    # The base may turn by 1100 deg: a turn of 1000 deg fits where it begins at -360 or 0, one of 1300 does not.
    base = builtin_rigs()["vertical-4"].frames
    rig = limited(
        Geometry.VERTICAL_4,
        base=span(base[0], -400, 700),
        outer=span(base[1], -60, 60),
        middle=span(base[2], -60, 60),
        inner=span(base[3], -60, 60),
    )
    time = np.arange(0.0, 20.0, 5e-3)
    s = time / time[-1]
    smooth = s - np.sin(2 * np.pi * s) / (2 * np.pi)
    attitude = from_euler(1000 * DEG * smooth, 20 * DEG * np.sin(6 * s), 0.1 * s)
    assert_flown(plan(time, attitude, rig), rig, time, attitude)
    beyond = plan(time, from_euler(1300 * DEG * smooth, 20 * DEG * np.sin(6 * s), 0.1 * s), rig)
    assert not beyond.verdict.feasible
    assert beyond.verdict.blocking is not None
    assert_inside(beyond, rig, time)


def assert_inside(result: Plan, rig: Rig, time: Array) -> None:
    """Limits hold, whatever became of the attitude; samples off the attitude are marked, and only they."""
    angles = result.solution.angles
    assert (angles >= rig.position_min - 1e-9).all()
    assert (angles <= rig.position_max + 1e-9).all()
    rates = np.diff(angles, axis=0) / np.diff(time)[:, None]
    assert (np.abs(rates) <= rig.max_rate * (1 + 1e-6)).all()
    accelerations = np.diff(rates, axis=0) / ((time[2:] - time[:-2]) / 2)[:, None]
    assert (np.abs(accelerations) <= rig.max_acceleration * (1 + 1e-6)).all()
    assert ((result.solution.matrix_error <= 1e-13) | (result.solution.limited != 0)).all()
    assert result.solution.limited_samples > 0


def test_too_fast_a_roll_is_refused_and_named() -> None:
    # 2000 deg/s about the nose with the nose on the horizon: no frame of this rig turns so fast.
    rig = builtin_rigs()["vertical-4"]
    time = np.arange(0.0, 4.0, 2e-3)
    fast = np.where((time > 2) & (time < 3), 2000 * DEG * (time - 2) ** 2, 0.0) + np.where(time >= 3, 2000 * DEG, 0.0)
    result = plan(time, from_euler(0.0, 0.3, fast), rig)
    assert not result.verdict.feasible
    blocking = result.verdict.blocking
    assert blocking is not None
    assert 1.9 <= blocking.time <= 3.2
    assert blocking.limit in ("rate", "acceleration")
    assert_inside(result, rig, time)


@pytest.mark.parametrize("geometry", [Geometry.VERTICAL_4, Geometry.HORIZONTAL_4])
def test_level_flight_on_the_singular_set(geometry: Geometry) -> None:
    # Pitch is zero throughout: d2 = 0 or d3 = +-90 deg everywhere on the curves (mathematics, section 3).
    rig = builtin_rigs()[geometry.value]
    time = np.arange(0.0, 8.0, 2e-3)
    attitude = from_euler(120 * DEG * np.sin(0.4 * time), 0.0 * time, 60 * DEG * np.sin(0.7 * time))
    assert_flown(plan(time, attitude, rig), rig, time, attitude)


def test_pitch_crosses_zero_with_roll_past_the_inner_limit() -> None:
    rig = builtin_rigs()["vertical-limited"]
    time = np.arange(0.0, 8.0, 2e-3)
    attitude = from_euler(0.2 * time, 25 * DEG * np.sin(0.9 * time), 75 * DEG + 30 * DEG * np.sin(0.5 * time))
    assert_flown(plan(time, attitude, rig), rig, time, attitude)


@pytest.mark.parametrize("samples", [1, 2, 3, 50])
def test_short_and_constant_flights(samples: int) -> None:
    rig = builtin_rigs()["vertical-limited"]
    time = 1e-3 * np.arange(samples)
    attitude = np.repeat(from_euler(np.array([1.0]), np.array([0.5]), np.array([2.5])), samples, axis=0)
    result = plan(time, attitude, rig)
    assert_flown(result, rig, time, attitude)
    assert np.ptp(result.solution.angles, axis=0).max() < 1e-13


@pytest.mark.parametrize("geometry", [Geometry.VERTICAL_4, Geometry.HORIZONTAL_4])
@pytest.mark.parametrize("cut", [180.0, 60.0, 20.0])
def test_a_constant_attitude_is_stood_not_flown(geometry: Geometry, cut: float) -> None:
    base = builtin_rigs()[geometry.value].frames
    rig = limited(geometry, inner=span(base[3], -cut, cut))
    time = 2e-3 * np.arange(1001)
    for seed in range(4):
        pose = Rotation.random(random_state=seed).as_matrix()
        noise = np.random.default_rng(seed).uniform(-2e-16, 2e-16, (len(time), 3, 3))  # as a converter rounds
        for attitude in (np.repeat(pose[None], len(time), axis=0), pose + noise):
            result = plan(time, attitude, rig)
            assert np.ptp(result.solution.angles, axis=0).max() < 1e-13
            assert not len(result.lead_in)
            assert not len(result.lead_out)
            if result.verdict.feasible:
                assert_flown(result, rig, time, attitude)


def test_a_constant_attitude_is_held_where_the_start_is() -> None:
    rig = builtin_rigs()["vertical-limited"]
    time = 2e-3 * np.arange(1001)
    start = np.array([1.0, 0.3, -0.4, 0.5])  # far from where home would have it
    attitude = np.repeat(payload(rig, start[None]), len(time), axis=0)
    result = plan(time, attitude, rig, start=start)
    assert_flown(result, rig, time, attitude)
    assert np.abs(result.solution.angles - start).max() < 1e-9


def test_uneven_time() -> None:
    rig = builtin_rigs()["vertical-limited"]
    rng = np.random.default_rng(5)
    time = np.cumsum(rng.uniform(1e-3, 4e-3, 3000))
    attitude = from_euler(0.8 * np.sin(time), 1.9 * np.sin(0.5 * time), 1.5 * np.sin(0.8 * time))
    assert_flown(plan(time, attitude, rig), rig, time, attitude)


def test_a_given_start_is_kept() -> None:
    rig = builtin_rigs()["vertical-limited"]
    time = np.arange(0.0, 6.0, 2e-3)
    attitude = from_euler(0.5 * np.sin(time), 0.4 + 0.5 * np.sin(0.7 * time), 0.8 * np.sin(time))
    start = plan(time, attitude, rig).solution.angles[0]
    result = plan(time, attitude, rig, start=start)
    assert_flown(result, rig, time, attitude)
    assert np.abs(result.solution.angles[0] - start).max() < 1e-9


def test_margins_are_those_of_the_angles() -> None:
    rig = builtin_rigs()["vertical-limited"]
    time = np.arange(0.0, 6.0, 2e-3)
    attitude = from_euler(0.5 * np.sin(time), 0.4 + 0.5 * np.sin(0.7 * time), 1.2 * np.sin(time))
    result = plan(time, attitude, rig)
    inner = result.solution.angles[:, 3]
    room = np.minimum(inner - rig.position_min[3], rig.position_max[3] - inner)
    value, when = result.margins.position[3]
    assert value == pytest.approx(room.min(), abs=1e-12)
    assert when == pytest.approx(time[int(np.argmin(room))], abs=1e-12)
