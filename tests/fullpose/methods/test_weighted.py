"""Weighted least squares with an adaptive base weight."""

import numpy as np
import pytest

from fullpose.attitude import dcm_from_euler, dcm_from_quaternion
from fullpose.methods.weighted import METHOD, WeightedOptions
from fullpose.rig import builtin_rigs
from fullpose.scenarios import SCENARIOS
from fullpose.verify import verify

RIG = builtin_rigs()["vertical-4"]


def test_the_base_rests_far_from_the_singularity_and_moves_near_it() -> None:
    time = np.arange(1001) / 1000.0
    yaw = 1.2 * time
    C = dcm_from_euler(yaw, np.full_like(time, 0.3), np.zeros_like(time))
    away = METHOD.stepper(RIG, WeightedOptions(far=1e4), np.zeros(4), C[0]).block(time, C).angles
    assert np.abs(away[:, 0]).max() < 0.01
    yaw = 1.2 + 0.5 * time
    C = dcm_from_euler(yaw, np.full_like(time, 0.05), np.zeros_like(time))
    near = METHOD.stepper(RIG, WeightedOptions(), np.array([0.0, 0.14, 1.2, 0.0]), C[0]).block(time, C).angles
    assert abs(np.cos(near[0, 2])) < 0.5
    assert np.abs(np.diff(near[:, 0])).max() > 5.0 * np.abs(np.diff(away[:, 0])).max()


@pytest.mark.parametrize("name", ["large_no_limit", "both_beyond_90", "double_loop"])
def test_closed_loop_does_not_drift(name: str) -> None:
    scenario = SCENARIOS[name]
    C = dcm_from_quaternion(scenario.quaternion)
    angles = METHOD.stepper(RIG, WeightedOptions(), None, C[0]).block(scenario.time, C).angles
    assert verify(scenario.time, angles, RIG, C).max_matrix_error < 1e-5
    half = len(C) // 2
    late = verify(scenario.time[half:], angles[half:], RIG, C[half:]).max_matrix_error
    assert late < 1e-5
