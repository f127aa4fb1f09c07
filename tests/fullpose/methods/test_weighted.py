"""Weighted least squares with an adaptive base weight."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from fullpose.attitude import dcm_from_euler, dcm_from_quaternion
from fullpose.kinematics import jacobian
from fullpose.methods.weighted import METHOD, WeightedOptions
from fullpose.rig import builtin_rigs
from fullpose.scenarios import SCENARIOS, random_flight
from fullpose.verify import payload_attitudes, verify

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


def test_a_step_is_the_weighted_least_norm_of_the_modules_law() -> None:
    options = WeightedOptions(far=50.0, near=0.5, width=0.4)
    time, q = random_flight(5, 0.2, 100.0, 2.0)
    C = dcm_from_quaternion(q)
    angles = METHOD.stepper(RIG, options, None, C[0]).block(time, C).angles
    attitude = payload_attitudes(RIG, angles)
    J = np.empty((3, 4))
    for k in range(1, time.size):
        d = angles[k - 1]
        w = RIG.weight.copy()
        w[0] *= 0.5 + (50.0 - 0.5) * (1.0 - np.exp(-((np.cos(d[2]) / 0.4) ** 2)))
        e = Rotation.from_matrix((C[k] @ attitude[k - 1].T).T).as_rotvec()
        jacobian(RIG.axes, d, J)
        expected = np.linalg.pinv(J / np.sqrt(w)) @ e / np.sqrt(w)
        np.testing.assert_allclose(angles[k] - d, expected, atol=1e-12)


@pytest.mark.parametrize("name", ["large_no_limit", "both_beyond_90", "double_loop"])
def test_closed_loop_does_not_drift(name: str) -> None:
    scenario = SCENARIOS[name]
    C = dcm_from_quaternion(scenario.quaternion)
    angles = METHOD.stepper(RIG, WeightedOptions(), None, C[0]).block(scenario.time, C).angles
    assert verify(scenario.time, angles, RIG, C).max_matrix_error < 1e-5
    half = len(C) // 2
    late = verify(scenario.time[half:], angles[half:], RIG, C[half:]).max_matrix_error
    assert late < 1e-5
