"""The scenario suite and the random flights."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from fullpose.attitude import dcm_from_quaternion
from fullpose.errors import InputError
from fullpose.rig import builtin_rigs
from fullpose.scenarios import DEG, SCENARIOS, random_flight

LONG = [name for name, scenario in SCENARIOS.items() if scenario.duration > 1.0]


@pytest.mark.parametrize("name", SCENARIOS)
def test_a_scenario_is_a_flight(name: str) -> None:
    scenario = SCENARIOS[name]
    time, q = scenario.time, scenario.quaternion
    assert scenario.rig in builtin_rigs()
    assert q.shape == (time.size, 4)
    assert np.all(np.diff(time) > 0.0)
    assert time[0] == 0.0
    assert time[-1] == pytest.approx(scenario.duration, abs=1e-12)
    np.testing.assert_allclose(np.linalg.norm(q, axis=1), 1.0, atol=1e-14)
    np.testing.assert_array_equal(scenario.quaternion, q)


@pytest.mark.parametrize("name", LONG)
def test_attitude_is_twice_differentiable(name: str) -> None:
    scenario = SCENARIOS[name]
    time = np.linspace(0.0, scenario.duration, 20_001)
    angles = np.stack([scenario.yaw.at(time), scenario.pitch.at(time), scenario.roll.at(time)])
    acceleration = np.diff(angles, 2) / np.diff(time)[0] ** 2
    # A jump in the second derivative would not shrink with the step.
    assert np.abs(np.diff(acceleration)).max() < 0.01 * max(1.0, np.abs(acceleration).max())


def test_euler_order_against_scipy() -> None:
    scenario = SCENARIOS["double_loop"]
    expected = Rotation.from_euler("YZX", scenario.euler).as_matrix()
    np.testing.assert_allclose(dcm_from_quaternion(scenario.quaternion).transpose(0, 2, 1), expected, atol=1e-14)


def test_a_tilt_turns_the_whole_flight_about_the_reference_x_axis() -> None:
    scenario = SCENARIOS["both_beyond_90"]
    level = replace(scenario, tilt=0.0)
    tilted = Rotation.from_rotvec([scenario.tilt, 0.0, 0.0]) * Rotation.from_quat(level.quaternion, scalar_first=True)
    difference = tilted.inv() * Rotation.from_quat(scenario.quaternion, scalar_first=True)
    assert difference.magnitude().max() < 1e-14
    euler = Rotation.from_euler("YZX", scenario.euler)
    assert (euler.inv() * tilted).magnitude().max() < 1e-13
    assert np.abs(np.diff(scenario.euler[:, [0, 2]], axis=0)).max() < 0.1  # unwrapped


def test_cases_are_what_they_say() -> None:
    def span(name: str) -> np.ndarray:
        return np.abs(SCENARIOS[name].euler).max(axis=0) / DEG

    assert np.all(span("small_angles") < 10.0)
    both = SCENARIOS["both_beyond_90"]
    assert min(both.yaw.at(both.time).max(), both.pitch.at(both.time).max()) > 90.0 * DEG
    assert span("over_limit_large_pitch")[1] == pytest.approx(120.0)
    assert span("over_limit_loop")[1] == pytest.approx(360.0)
    assert span("level")[1] == 0.0
    assert SCENARIOS["one_sample"].time.size == 1
    assert SCENARIOS["two_samples"].time.size == 2
    steps = np.diff(SCENARIOS["non_uniform"].time)
    assert steps.max() > 1.5 * steps.min()


def test_random_flight_is_one_flight_at_any_rate() -> None:
    coarse_time, coarse = random_flight(7, 5.0, 1000.0, 2.0)
    fine_time, fine = random_flight(7, 5.0, 4000.0, 2.0)
    np.testing.assert_allclose(fine_time[::4], coarse_time, atol=1e-12)
    np.testing.assert_allclose(fine[::4], coarse, atol=1e-11)
    assert not np.allclose(random_flight(8, 5.0, 1000.0, 2.0)[1], coarse)


def test_random_flight_has_the_body_rate_asked_for() -> None:
    time, q = random_flight(3, 20.0, 1000.0, np.deg2rad(60.0))
    r = Rotation.from_quat(q, scalar_first=True)
    rate = (r[:-1].inv() * r[1:]).as_rotvec() / np.diff(time)[:, None]
    assert np.sqrt(np.mean(np.sum(rate**2, axis=1))) == pytest.approx(np.deg2rad(60.0), rel=1e-3)
    assert np.all(np.sum(q[1:] * q[:-1], axis=1) > 0.0)


@pytest.mark.parametrize("arguments", [(0.0, 1000.0, 1.0), (1.0, -1.0, 1.0), (1.0, 1000.0, float("nan"))])
def test_random_flight_refuses(arguments: tuple[float, float, float]) -> None:
    with pytest.raises(InputError):
        random_flight(0, *arguments)
