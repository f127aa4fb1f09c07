"""The gradient in the null space."""

import numpy as np
import pytest

from fullpose._typing import Array
from fullpose.attitude import dcm_from_quaternion
from fullpose.bounds import EXACT
from fullpose.kinematics import jacobian, payload_attitude, rotation_error
from fullpose.methods.block import record_of
from fullpose.methods.gradient_projection import METHOD, GradientProjectionOptions, ascent
from fullpose.methods.state import new_flight
from fullpose.rig import builtin_rigs
from fullpose.scenarios import SCENARIOS, random_flight

RIG = builtin_rigs()["vertical-limited"]


def height(d: np.ndarray, limits: float, singularity: float) -> float:
    """k H by the formula of the module."""
    total = singularity * (np.sin(d[1]) ** 2 + np.cos(d[2]) ** 2)
    for i in range(4):
        if np.isfinite(RIG.position_max[i]):
            low, high = RIG.position_min[i], RIG.position_max[i]
            u = (2.0 * d[i] - low - high) / (high - low)
            total -= limits / (1.0 - u * u)
    return float(total)


def gradient(d: Array, options: GradientProjectionOptions) -> Array:
    """k grad H at d (4,) [rad/s]."""
    flight = new_flight(RIG, d, EXACT, np.eye(3))
    flight.ahead = 1.0
    ascent(flight, record_of(options)[0])
    return flight.increment.copy()


def test_the_gradient_against_finite_differences() -> None:
    random = np.random.default_rng(0)
    options = GradientProjectionOptions(limits=0.05, singularity=0.5, max_rate=1e3)
    for _ in range(50):
        d = random.uniform(-1.0, 1.0, 4)
        g = gradient(d, options)
        step = 1e-6
        for i in range(4):
            h = np.eye(4)[i] * step
            slope = (height(d + h, 0.05, 0.5) - height(d - h, 0.05, 0.5)) / (2.0 * step)
            assert g[i] == pytest.approx(slope, abs=1e-6)


def test_the_gradient_is_held_and_points_inward_beyond_the_limit() -> None:
    g = gradient(np.array([0.0, 0.5, 0.5, np.deg2rad(75.0)]), GradientProjectionOptions(max_rate=0.7))
    assert np.linalg.norm(g) == pytest.approx(0.7)
    assert g[3] < 0.0


def test_a_step_is_the_papers_formula() -> None:
    options = GradientProjectionOptions()
    time, q = random_flight(3, 0.1, 100.0, 2.0)
    C = dcm_from_quaternion(q)
    angles = METHOD.stepper(RIG, options, None, C[0]).block(time, C).angles
    J, F, e = np.empty((3, 4)), np.empty((3, 3)), np.empty(3)
    for k in range(1, time.size):
        d = angles[k - 1]
        payload_attitude(RIG.axes, d, F)
        rotation_error(C[k], F, e)
        jacobian(RIG.axes, d, J)
        g = gradient(d, options)
        inverse = np.linalg.pinv(J)
        expected = inverse @ e + (np.eye(4) - inverse @ J) @ g * (time[k] - time[k - 1])
        np.testing.assert_allclose(angles[k] - d, expected, atol=1e-12)


def test_the_gradient_keeps_away_from_the_limit() -> None:
    scenario = SCENARIOS["over_limit_large_pitch"]
    C = dcm_from_quaternion(scenario.quaternion)

    def beyond(limits: float) -> float:
        options = GradientProjectionOptions(limits=limits, max_rate=3.0)
        angles = METHOD.stepper(RIG, options, None, C[0]).block(scenario.time, C).angles
        return float(np.mean(np.abs(angles[:, 3]) > RIG.position_max[3]))

    assert beyond(0.5) < 0.7 * beyond(0.0)
