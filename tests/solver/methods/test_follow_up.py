"""The base as a follow-up axis."""

import math

import numpy as np
import pytest

from solver.attitude import dcm_from_euler, dcm_from_quaternion
from solver.methods.follow_up import METHOD, FollowUpOptions
from solver.rig import builtin_rigs
from solver.scenarios import SCENARIOS, random_flight
from solver.verify import differences, verify

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
