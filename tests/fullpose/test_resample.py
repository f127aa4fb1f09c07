"""Resampling to the rig's rate."""

from importlib import import_module

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from fullpose.errors import InputError
from fullpose.resample import Choice, continuous, resample
from fullpose.scenarios import SCENARIOS, random_flight


def geodesic(a: NDArray[np.float64], b: NDArray[np.float64]) -> NDArray[np.float64]:
    ra, rb = (Rotation.from_quat(q, scalar_first=True) for q in (a, b))
    return (ra.inv() * rb).magnitude()


def test_samples_on_the_grid_are_kept() -> None:
    time, q = random_flight(1, 3.0, 1000.0, 1.0)
    rounded = np.round(time + 0.0000004, 6)
    out = resample(rounded, q, 1000.0)
    assert out.choice is Choice.KEPT
    np.testing.assert_array_equal(out.time, rounded)
    np.testing.assert_allclose(out.q, q, atol=1e-15)


def test_sparse_samples_go_through_the_spline() -> None:
    dense_time, dense = random_flight(2, 5.0, 1000.0, 1.0)
    out = resample(dense_time[::10], dense[::10], 1000.0)
    assert out.choice is Choice.SPLINE
    assert "100 Hz" in out.sentence
    np.testing.assert_allclose(out.time, dense_time, atol=1e-12)
    assert geodesic(out.q[200:-200], dense[200:-200]).max() < 1e-8
    np.testing.assert_allclose(geodesic(out.q[::10], dense[::10]), 0.0, atol=1e-12)


def test_body_rate_is_the_derivative_of_the_attitude() -> None:
    time, q = random_flight(3, 4.0, 100.0, 2.0)
    out = resample(time, q, 2000.0)
    r = Rotation.from_quat(out.q, scalar_first=True)
    middle = (r[:-2].inv() * r[2:]).as_rotvec() / (out.time[2:] - out.time[:-2])[:, None]
    np.testing.assert_allclose(out.body_rate[1:-1], middle, atol=5e-5)


def test_long_flights_take_several_windows(monkeypatch: pytest.MonkeyPatch) -> None:
    time, q = random_flight(4, 6.0, 100.0, 1.0)
    whole = resample(time, q, 1000.0)
    monkeypatch.setattr(import_module("fullpose.resample"), "_WINDOW", 150)
    parts = resample(time, q, 1000.0)
    assert geodesic(whole.q, parts.q).max() < 1e-12
    np.testing.assert_allclose(whole.body_rate, parts.body_rate, atol=1e-10)


def test_signs_and_lengths_do_not_matter() -> None:
    time, q = random_flight(5, 1.0, 50.0, 1.0)
    spoiled = q * np.where(np.arange(time.size) % 3 == 0, -3.0, 1e-200)[:, None]
    np.testing.assert_allclose(geodesic(resample(time, spoiled, 500.0).q, resample(time, q, 500.0).q), 0.0, atol=1e-12)
    signs = np.sum(resample(time, spoiled, 500.0).q[1:] * resample(time, spoiled, 500.0).q[:-1], axis=1)
    assert signs.min() > 0.0


def test_uneven_and_denser_samples() -> None:
    scenario = SCENARIOS["non_uniform"]
    out = resample(scenario.time, scenario.quaternion, 1000.0)
    assert out.choice is Choice.SPLINE
    uniform = SCENARIOS["large_no_limit"]
    np.testing.assert_allclose(out.time, uniform.time, atol=1e-12)
    assert geodesic(out.q, uniform.quaternion)[20:-20].max() < 1e-12  # the ends: SciPy's end condition
    assert "left out" in resample(uniform.time, uniform.quaternion, 100.0).sentence


def test_a_wide_gap_is_said() -> None:
    q = Rotation.from_rotvec([[0.0, 0.0, 0.0], [2.0, 0.0, 0.0], [2.0, 0.0, 0.0]]).as_quat(scalar_first=True)
    assert "115 deg apart" in resample(np.array([0.0, 1.0, 2.0]), q, 100.0).sentence


@pytest.mark.parametrize("name", ["one_sample", "two_samples"])
def test_short_flights(name: str) -> None:
    scenario = SCENARIOS[name]
    out = resample(scenario.time, scenario.quaternion, 1000.0)
    np.testing.assert_allclose(out.q, scenario.quaternion, atol=1e-15)
    assert out.body_rate.shape == (scenario.time.size, 3)


def test_two_sparse_samples_turn_steadily() -> None:
    q = Rotation.from_rotvec([[0.0, 0.0, 0.0], [0.3, 0.0, 0.0]]).as_quat(scalar_first=True)
    out = resample(np.array([5.0, 6.0]), q, 10.0)
    assert out.time.size == 11
    np.testing.assert_allclose(out.body_rate, np.tile([0.3, 0.0, 0.0], (11, 1)), atol=1e-12)


def test_a_last_partial_period_is_left_out() -> None:
    time, q = random_flight(6, 1.0, 64.0, 1.0)
    assert resample(time, q, 10.0).time[-1] == pytest.approx(1.0)
    assert resample(time[:-1], q[:-1], 10.0).time[-1] == pytest.approx(0.9)


def test_continuous_keeps_the_first_sign() -> None:
    q = np.array([[-1.0, 0.0, 0.0, 0.0], [1.0, 0.0, 0.0, 0.0], [-1.0, 0.0, 0.0, 0.0]])
    np.testing.assert_array_equal(continuous(q), np.tile([-1.0, 0.0, 0.0, 0.0], (3, 1)))


ONE = np.array([1.0, 0.0, 0.0, 0.0])


@pytest.mark.parametrize(
    ("time", "q", "rate", "sample"),
    [
        (np.array([]), np.empty((0, 4)), 100.0, None),
        (np.array([0.0, 1.0]), np.tile(ONE, (3, 1)), 100.0, None),
        (np.array([0.0, 1.0, 1.0]), np.tile(ONE, (3, 1)), 100.0, 2),
        (np.array([0.0, np.nan, 1.0]), np.tile(ONE, (3, 1)), 100.0, 1),
        (np.array([np.inf, 1.0]), np.tile(ONE, (2, 1)), 100.0, 0),
        (np.array([0.0, 1.0]), np.stack([ONE, 0.0 * ONE]), 100.0, 1),
        (np.array([0.0, 1.0]), np.stack([ONE * np.nan, ONE]), 100.0, 0),
        (np.array([0.0, 1.0]), np.tile(ONE, (2, 1)), 0.0, None),
    ],
)
def test_refuses_what_is_not_a_flight(
    time: NDArray[np.float64], q: NDArray[np.float64], rate: float, sample: int | None
) -> None:
    with pytest.raises(InputError) as caught:
        resample(time, q, rate)
    assert caught.value.sample == sample


@pytest.mark.parametrize(
    ("time", "name"), [([0.0, 1e-300], "time"), ([-1e308, 1.5e308], "time"), ([0, 1e6], "duration_s")]
)
def test_times_beyond_reason_are_refused(time: list[float], name: str) -> None:
    with pytest.raises(InputError) as caught:
        resample(np.array(time), np.array([[1.0, 0, 0, 0], [0.0, 1.0, 0, 0]]), 1000.0)
    assert caught.value.name == name
