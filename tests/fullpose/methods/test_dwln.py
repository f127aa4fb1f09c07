"""Damped weighted least norm with the exact re-solve."""

import math
from typing import Any

import numpy as np
import pytest

from fullpose.attitude import dcm_from_euler, dcm_from_quaternion
from fullpose.bounds import EXACT
from fullpose.kinematics import jacobian
from fullpose.limits import WEIGHT
from fullpose.methods.block import record_of
from fullpose.methods.dwln import (
    LONGEST,
    METHOD,
    DwlnOptions,
    damped_step,
    dwln_weights,
    limit_gradient,
    smallest_singular_value,
)
from fullpose.methods.state import new_flight
from fullpose.methods.three_axis import METHOD as THREE_AXIS
from fullpose.methods.three_axis import ThreeAxisOptions
from fullpose.resample import resample
from fullpose.rig import builtin_rigs
from fullpose.scenarios import SCENARIOS, random_flight
from fullpose.verify import verify

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
    options = DwlnOptions(base_weight=5.0, outer_gain=3.0, outer_width=0.2, middle_width=0.4)
    flight = new_flight(RIGS["vertical-4"], np.zeros(4), EXACT, np.eye(3))
    flight.limits[WEIGHT] = 2.0, 3.0, 4.0, 5.0
    flight.weight[:] = flight.limits[WEIGHT]
    flight.next[:] = 0.3, 0.1, 1.4, -0.5
    H = limit_gradient(1.4)
    bump = 3.0 * math.exp(-((math.sin(0.1) / 0.2) ** 2) - (math.cos(1.4) / 0.4) ** 2)
    dwln_weights(flight, record_of(options)[0], 0.01)
    np.testing.assert_allclose(flight.weight, [2.0 * 5.0 / (1 + H), 3.0 * (1 + bump), 4.0 * (1 + H), 5.0])
    dwln_weights(flight, record_of(options)[0], -0.01)
    assert flight.weight[2] == 4.0


def weighted_step(J: np.ndarray, w: np.ndarray, e: np.ndarray, damping: float) -> np.ndarray:
    flight = new_flight(RIGS["vertical-4"], np.zeros(4), EXACT, np.eye(3))
    flight.J[:], flight.weight[:], flight.e[:] = J, w, e
    damped_step(flight, damping)
    return flight.step.copy()


def test_a_step_is_the_papers_formula() -> None:
    random = np.random.default_rng(1)
    for _ in range(200):
        J, w, e = random.normal(size=(3, 4)), np.exp(random.normal(size=4)), 1e-3 * random.normal(size=3)
        damping = random.choice([0.0, 1e-4])
        WJ = J.T / w[:, None]
        expected = WJ @ np.linalg.solve(J @ WJ + damping * np.eye(3), e)
        np.testing.assert_allclose(weighted_step(J, w, e, damping), expected, rtol=1e-6, atol=1e-12)


def test_a_step_is_finite_and_short_at_any_weights() -> None:
    """On the rig's singularity too, without the options' damping."""
    random = np.random.default_rng(2)
    J = np.empty((3, 4))
    for k in range(500):
        pose = random.uniform(-np.pi, np.pi, 4)
        if k % 2:
            pose[1:3] = 0.0, 0.5 * np.pi
        jacobian(RIGS["vertical-4"].axes, pose, J)
        w = 10.0 ** random.uniform(-12.0, 12.0, 4)
        p = weighted_step(J, w, random.normal(size=3), 0.0)
        assert np.abs(p).max() <= LONGEST * (1.0 + 1e-12)


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


def test_a_slow_flight_moves_the_base() -> None:
    """Less than the tolerance a sample: 75 000 deg/s^2, when the base stood until the middle frame's pole was there."""
    time = np.arange(10_001) / 1000.0
    C = dcm_from_euler(np.radians(80.0 + 0.9 * time), np.full_like(time, np.radians(0.02)), 0.0 * time)
    start = np.radians([-2.0, 0.0, 80.0, 0.0])
    angles = METHOD.stepper(RIGS["vertical-4"], DwlnOptions(), start, C[0]).block(time, C).angles
    result = verify(time, angles, RIGS["vertical-4"], C)
    assert result.max_error < math.radians(1e-9)
    assert result.peaks[:, 1].max() < math.radians(2.0)
    assert result.peaks[:, 2].max() < math.radians(100.0)


def test_a_high_sample_rate_does_not_chatter_about_the_tolerance() -> None:
    """both_beyond_90 ten times as slow, at 5 kHz: its peak acceleration of 71 deg/s^2 falls by a hundred."""
    scenario = SCENARIOS["both_beyond_90"]
    flight = resample(scenario.time[:2000:10] * 10.0, scenario.quaternion[:2000:10], 5000.0)
    C = dcm_from_quaternion(flight.q)
    angles = METHOD.stepper(RIGS["vertical-4"], DwlnOptions(), None, C[0]).block(flight.time, C).angles
    assert verify(flight.time, angles, RIGS["vertical-4"], C).peaks[:, 2].max() < math.radians(1.0)


@pytest.mark.parametrize("exact", [True, False])
@pytest.mark.parametrize(
    "extreme",
    [
        {"outer_gain": 1e6, "outer_width": 1e3, "middle_width": 1e3},
        {"damping_below": 0.0, "max_damping": 0.0},
        {"base_weight": 1e-6, "outer_gain": 1e6, "outer_width": 1e3, "middle_width": 1e3, "max_damping": 0.0},
        {"base_weight": 1e6, "damping_below": 1.0, "max_damping": 1.0},
    ],
)
@pytest.mark.parametrize("rig", ["vertical-4", "horizontal-4"])
def test_no_legal_option_breaks_it(rig: str, extreme: dict[str, Any], exact: bool) -> None:
    for name in ("over_limit_small_pitch", "both_beyond_90", "singular_start", "level"):
        scenario = SCENARIOS[name]
        C = dcm_from_quaternion(scenario.quaternion)
        start = None if scenario.start is None else np.array(scenario.start)
        options = DwlnOptions(exact=exact, **extreme)
        angles = METHOD.stepper(RIGS[rig], options, start, C[0]).block(scenario.time, C).angles
        # A re-solve at the middle frame's pole may turn half round, no iterate may.
        assert np.abs(np.diff(angles, axis=0)).max() < (math.pi + 0.5 if exact else options.max_iterations * LONGEST)
        assert np.abs(angles).max() < 100.0
