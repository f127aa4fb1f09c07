"""Damped weighted least norm with the exact re-solve."""

import math

import numpy as np
import pytest

from solver.attitude import dcm_from_quaternion
from solver.methods.dwln import METHOD, DwlnOptions, dwln_weights, limit_gradient, smallest_singular_value
from solver.methods.three_axis import METHOD as THREE_AXIS
from solver.methods.three_axis import ThreeAxisOptions
from solver.rig import builtin_rigs
from solver.scenarios import SCENARIOS, random_flight
from solver.verify import verify

RIGS = builtin_rigs()


def test_smallest_singular_value_against_svd() -> None:
    random = np.random.default_rng(0)
    for _ in range(200):
        J = random.normal(size=(3, 4))
        assert smallest_singular_value(J) == pytest.approx(np.linalg.svd(J)[1][-1], abs=1e-8)
    assert smallest_singular_value(np.eye(3, 4)) == pytest.approx(1.0)
    assert smallest_singular_value(np.diag([1.0, 1.0, 0.0]) @ np.ones((3, 4))) < 1e-7


def test_limit_gradient_is_the_derivative_of_chan_and_dubeys_function() -> None:
    def h(d3: float) -> float:
        return math.pi**2 / (4.0 * (math.pi / 2 - d3) * (d3 + math.pi / 2))

    for d3 in np.linspace(-1.5, 1.5, 31):
        slope = (h(d3 + 1e-6) - h(d3 - 1e-6)) / 2e-6
        assert limit_gradient(d3) == pytest.approx(abs(slope), rel=1e-6, abs=1e-9)
    assert math.isfinite(limit_gradient(math.pi / 2))
    assert limit_gradient(1.0 + 2.0 * math.pi) == pytest.approx(limit_gradient(1.0))


def test_weights() -> None:
    K, A, B1, B2 = 5.0, 3.0, 0.2, 0.4
    parameters, unit, w = np.array([K, A, B1, B2]), np.ones(4), np.empty(4)
    x = np.array([0.3, 0.1, 1.4, -0.5])
    H = limit_gradient(1.4)
    bump = A * math.exp(-((math.sin(0.1) / B1) ** 2) - (math.cos(1.4) / B2) ** 2)
    dwln_weights(unit, parameters, x, 0.01, w)
    np.testing.assert_allclose(w, [K / (1 + H), 1 + bump, 1 + H, 1.0])
    dwln_weights(unit, parameters, x, -0.01, w)
    assert w[2] == 1.0


def run(rig: str, name: str, options: DwlnOptions) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    scenario = SCENARIOS[name]
    C = dcm_from_quaternion(scenario.quaternion)
    block = METHOD.stepper(RIGS[rig], options, None, C[0]).block(scenario.time, C)
    return scenario.time, C, block.angles, block.iterations


@pytest.mark.parametrize("rig", ["vertical-4", "horizontal-4"])
def test_published_error_and_smoothness(rig: str) -> None:
    """Lin 2022: errors of 5e-9 deg and below, smooth where the three-axis rigs' rates blow up."""
    time, C, angles, _ = run(rig, "both_beyond_90", DwlnOptions())
    ours = verify(time, angles, RIGS[rig], C)
    assert ours.max_error < math.radians(1e-9)
    assert not ours.violations
    euler = THREE_AXIS.stepper(RIGS[rig], ThreeAxisOptions(), None, C[0]).block(time, C).angles
    assert ours.peaks[:, 2].max() < 0.05 * verify(time, euler, RIGS[rig], C).peaks[:, 2].max()


def test_iterates_to_the_tolerance_without_the_re_solve() -> None:
    options = DwlnOptions(exact=False)
    time, C, angles, iterations = run("vertical-4", "large_no_limit", options)
    assert verify(time, angles, RIGS["vertical-4"], C).max_error < options.tolerance
    tight = DwlnOptions(exact=False, tolerance=1e-12)
    time, C, angles, more = run("vertical-4", "large_no_limit", tight)
    assert verify(time, angles, RIGS["vertical-4"], C).max_error < 2e-12
    assert iterations.sum() < more.sum()
    assert more.max() <= tight.max_iterations


def test_the_middle_frame_stays_on_its_side() -> None:
    for seed in range(6):
        time, q = random_flight(seed, 5.0, 500.0, 1.5)
        C = dcm_from_quaternion(q)
        angles = METHOD.stepper(RIGS["vertical-4"], DwlnOptions(), None, C[0]).block(time, C).angles
        assert np.cos(angles[:, 2]).min() > -1e-12
