"""The base as a follow-up axis."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fullpose.attitude import dcm_from_euler, dcm_from_quaternion
from fullpose.methods.follow_up import METHOD, FollowUpOptions
from fullpose.rig import FrameLimits, Geometry, Rig, builtin_rigs
from fullpose.scenarios import SCENARIOS, random_flight
from fullpose.verify import differences, verify

RIGS = builtin_rigs()


def test_away_from_the_pole_the_base_follows_the_nose() -> None:
    time = np.arange(5001) / 1000.0
    yaw = 0.8 * np.sin(0.5 * time)
    C = dcm_from_euler(yaw, 0.3 * np.sin(time), 0.5 * time)
    angles = METHOD.stepper(RIGS["vertical-4"], FollowUpOptions(), None, C[0]).block(time, C).angles
    assert np.abs(angles[2500:, 0] - yaw[2500:]).max() < math.radians(6.0)
    assert np.abs(angles[2500:, 2]).max() < math.radians(6.0)


@pytest.mark.parametrize("rig", ["vertical-4", "horizontal-4"])
def test_turns_aside_at_the_pole_and_holds_the_attitude(rig: str) -> None:
    scenario = SCENARIOS["both_beyond_90"]
    time, C = scenario.time, dcm_from_quaternion(scenario.quaternion)
    angles = METHOD.stepper(RIGS[rig], FollowUpOptions(), None, C[0]).block(time, C).angles
    result = verify(time, angles, RIGS[rig], C)
    assert result.max_matrix_error < 5e-15
    assert result.peaks[:, 1].max() < math.radians(300.0)
    assert np.ptp(angles[:, 0]) > math.radians(80.0)


def test_the_servo_keeps_its_own_limits() -> None:
    rig = RIGS["vertical-4"]
    options = FollowUpOptions(max_rate=1.0, max_acceleration=3.0)
    for seed in range(4):
        time, q = random_flight(seed, 4.0, 500.0, 1.0)
        C = dcm_from_quaternion(q)
        rate, acceleration = differences(time, METHOD.stepper(rig, options, None, C[0]).block(time, C).angles)
        assert np.abs(rate[:, 0]).max() <= 1.0 + 1e-9
        assert np.abs(acceleration[:, 0]).max() <= 3.0 + 1e-6


def with_base(base: FrameLimits, geometry: Geometry = Geometry.VERTICAL_4) -> Rig:
    return Rig("base", geometry, (base, FrameLimits(), FrameLimits(), FrameLimits()))


@pytest.mark.parametrize(
    "base", [FrameLimits(max_rate=math.radians(10.0), max_acceleration=math.radians(20.0)), FrameLimits(0.0, 0.0)]
)
@pytest.mark.parametrize("name", ["level", "large_no_limit"])
def test_a_base_that_cannot_follow_costs_half_turns_but_no_run_away(name: str, base: FrameLimits) -> None:
    """The chart's fold turns the frames half round; the next sample must not go on from there."""
    scenario = SCENARIOS[name]
    time, C = scenario.time, dcm_from_quaternion(scenario.quaternion)
    rig = with_base(base)
    angles = METHOD.stepper(rig, FollowUpOptions(), None, C[0]).block(time, C).angles
    step = np.abs(np.diff(angles, axis=0))
    assert step.max() < math.pi + 0.1
    assert np.count_nonzero(step.max(axis=1) > 1.0) <= 4
    assert np.abs(angles).max() < 10.0
    assert verify(time, angles, rig, C).max_matrix_error < 5e-14


@settings(max_examples=60)
@given(
    seed=st.integers(0, 10_000),
    sample_rate=st.sampled_from([2.0, 5.0, 20.0, 100.0, 1000.0]),
    bandwidth=st.sampled_from([0.1, 1.0, 10.0, 1000.0]),
    max_rate=st.floats(0.05, 5.0),
    max_acceleration=st.floats(0.05, 20.0),
    half_range=st.sampled_from([0.0, 0.5, 3.0, math.inf]),
    horizontal=st.booleans(),
    uneven=st.booleans(),
)
def test_the_base_keeps_its_limits(
    seed: int,
    sample_rate: float,
    bandwidth: float,
    max_rate: float,
    max_acceleration: float,
    half_range: float,
    horizontal: bool,
    uneven: bool,
) -> None:
    base = FrameLimits(-half_range, half_range, max_rate, max_acceleration)
    rig = with_base(base, Geometry.HORIZONTAL_4 if horizontal else Geometry.VERTICAL_4)
    time, q = random_flight(seed, 300.0 / sample_rate, sample_rate, 2.0)
    if uneven:
        keep = np.random.default_rng(seed).random(len(time)) < 0.4
        keep[:2] = True
        time, q = time[keep], q[keep]
    C = dcm_from_quaternion(q)
    angles = METHOD.stepper(rig, FollowUpOptions(bandwidth=bandwidth), None, C[0]).block(time, C).angles
    result = verify(time, angles, rig, C)
    assert result.violations == ()
    assert result.max_matrix_error < 1e-13
    # From rest, as the servo has it.
    assert abs(angles[1, 0] - angles[0, 0]) <= max_acceleration * (time[1] - time[0]) ** 2 * (1.0 + 1e-6)


@pytest.mark.parametrize("sample_rate", [2.0, 5.0])
def test_the_servo_is_stable_at_few_samples_a_second(sample_rate: float) -> None:
    time = np.arange(0.0, 60.0, 1.0 / sample_rate)
    C = dcm_from_euler(np.where(time > 1.0, 0.5, 0.0), 0.0 * time, 0.0 * time)
    angles = METHOD.stepper(RIGS["vertical-4"], FollowUpOptions(), None, C[0]).block(time, C).angles
    assert angles[:, 0].max() < 0.5 + 1e-9
    assert angles[-1, 0] == pytest.approx(0.5, abs=1e-6)


def test_starts_with_the_base_in_its_range_though_no_pose_is() -> None:
    stop = FrameLimits(-0.1, 0.1)
    rig = Rig("narrow", Geometry.VERTICAL_4, (stop, stop, stop, stop))
    C = dcm_from_euler([1.0, 1.01], [0.8, 0.8], [0.5, 0.5])
    angles = METHOD.stepper(rig, FollowUpOptions(), None, C[0]).block(np.array([0.0, 0.01]), C).angles
    assert np.abs(angles[:, 0]).max() <= 0.1
    assert verify([0.0, 0.01], angles, rig, C).max_matrix_error < 1e-14
