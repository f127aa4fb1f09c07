"""Diagnosis of recorded flights: flights that SciPy makes, and what recording does to them."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from fullpose.errors import InputError
from fullpose.recorded import Diagnosis, diagnose
from tests.support.recorded import FLIGHTS, grid, noisy, quaternion, rounded_angles, truth

RATES = [100.0, 400.0, 1000.0, 2000.0]


def nothing_found(d: Diagnosis) -> None:
    assert d.quantum_rad == 0.0
    assert d.held.count == 0
    assert not d.stamps.explained
    assert d.near_duplicates.size == 0
    assert d.gaps == ()
    assert d.outliers.sample.size == 0
    np.testing.assert_array_equal(d.white_noise_rad, 0.0)


@pytest.mark.parametrize("rate", RATES)
@pytest.mark.parametrize("name", FLIGHTS)
def test_a_clean_flight_is_clean(name: str, rate: float) -> None:
    time = grid(rate)
    nothing_found(diagnose(time, quaternion(truth(name, time))))


@pytest.mark.parametrize("name", FLIGHTS)
def test_a_clean_flight_of_eight_decimals_is_clean_but_for_them(name: str) -> None:
    time = grid(1000.0)
    d = diagnose(time, quaternion(rounded_angles(truth(name, time), 8)))
    assert d.noise_acceleration_rad_s2.max() < np.radians(0.05)
    assert d.outliers.sample.size == d.held.count == 0


@pytest.mark.parametrize("sigma", [1e-4, 1e-3, 0.01, 0.05])
@pytest.mark.parametrize("rate", [200.0, 1000.0])
@pytest.mark.parametrize("name", FLIGHTS)
def test_white_noise_is_measured(name: str, rate: float, sigma: float) -> None:
    time = grid(rate, 2000.0 / rate)
    d = diagnose(time, quaternion(noisy(truth(name, time), sigma)))
    assert d.noise_measured
    np.testing.assert_allclose(np.degrees(d.white_noise_rad), sigma, rtol=0.15)
    np.testing.assert_allclose(d.noise_acceleration_rad_s2, d.white_noise_rad * np.sqrt(6.0) * rate**2, rtol=1e-6)
    assert d.outliers.sample.size == 0
    assert d.quantum_rad == 0.0


def test_noise_is_told_by_axis() -> None:
    time = grid(1000.0)
    sigma = np.array([0.001, 0.01, 0.0])
    d = diagnose(time, quaternion(noisy(truth("manoeuvre", time), sigma)))
    np.testing.assert_allclose(np.degrees(d.white_noise_rad), sigma, rtol=0.1, atol=2e-5)


@pytest.mark.parametrize("decimals", [1, 2, 3, 4])
@pytest.mark.parametrize("name", FLIGHTS)
def test_decimals_of_angles_are_found(name: str, decimals: int) -> None:
    time = grid(1000.0)
    d = diagnose(time, quaternion(rounded_angles(truth(name, time), decimals)))
    assert d.quantum.of == "angles_deg"
    assert d.quantum.unit == 10.0**-decimals
    assert d.quantum_rad == np.radians(10.0**-decimals)
    assert d.held.count == 0
    assert d.outliers.sample.size == 0


@pytest.mark.parametrize("unit", [1.0, -1.0, 1.0003])
@pytest.mark.parametrize("decimals", [3, 4, 5, 6])
@pytest.mark.parametrize("name", FLIGHTS)
def test_decimals_of_quaternions_are_found(name: str, decimals: int, unit: float) -> None:
    """Made unit or not, whichever sign."""
    time = grid(1000.0)
    q = np.round(quaternion(truth(name, time)), decimals)
    d = diagnose(time, unit * q)
    assert d.quantum.of == "quaternion"
    assert d.quantum.unit == 10.0**-decimals
    assert d.held.count == 0


def test_the_counts_of_an_encoder_are_found() -> None:
    time = grid(1000.0)
    unit = 360.0 / 2**16
    angles = np.round(truth("manoeuvre", time).as_euler("YZX", degrees=True) / unit) * unit
    d = diagnose(time, quaternion(Rotation.from_euler("YZX", angles, degrees=True)))
    assert (d.quantum.of, d.quantum.unit) == ("counts", unit)


def test_whole_steps_are_not_rounding() -> None:
    """A spin of 3.6 deg a sample has one decimal and nothing was rounded away."""
    time = grid(100.0)
    assert (
        diagnose(time, quaternion(Rotation.from_euler("x", (360.0 * time)[:, None], degrees=True))).quantum_rad == 0.0
    )


@pytest.mark.parametrize(("rate", "true_rate"), [(400.0, 50.0), (1000.0, 250.0), (1000.0, 100.0), (200.0, 100.0)])
@pytest.mark.parametrize("name", FLIGHTS)
def test_held_samples_are_found(name: str, rate: float, true_rate: float) -> None:
    time = grid(rate)
    length = round(rate / true_rate)
    index = np.arange(time.size)
    d = diagnose(time, quaternion(truth(name, time))[index - index % length])
    assert d.held.rate_hz == pytest.approx(true_rate, rel=1e-9)
    assert d.held.length == length
    if name != "rest_and_turn":
        np.testing.assert_array_equal(d.held.mask, index % length > 0)
    np.testing.assert_array_equal(d.white_noise_rad, 0.0)


def test_a_hold_of_no_whole_number_of_samples() -> None:
    time = grid(400.0, 10.0)
    held = np.floor(time * 60.0 + 1e-9) / 60.0
    d = diagnose(time, quaternion(truth("manoeuvre", held)))
    assert d.held.rate_hz == pytest.approx(60.0, rel=1e-3)


def test_noise_is_measured_under_a_hold() -> None:
    time = grid(1000.0)
    index = np.arange(time.size)
    q = quaternion(noisy(truth("manoeuvre", time), 0.01))[index - index % 4]
    d = diagnose(time, q)
    np.testing.assert_allclose(np.degrees(d.white_noise_rad), 0.01, rtol=0.15)


def test_single_repeated_samples_are_found() -> None:
    time = grid(400.0)
    q = quaternion(truth("manoeuvre", time))
    repeated = np.array([300, 700, 701, 1200])
    q[repeated] = q[[299, 699, 699, 1199]]
    d = diagnose(time, q)
    np.testing.assert_array_equal(np.flatnonzero(d.held.mask), repeated)
    assert d.held.rate_hz is None


@pytest.mark.parametrize("sigma", [0.0, 0.01])
@pytest.mark.parametrize("name", FLIGHTS)
def test_outliers_are_found(name: str, sigma: float) -> None:
    time = grid(1000.0)
    attitude = noisy(truth(name, time), sigma)
    off = np.zeros((time.size, 3))
    off[[700, 1500, 1501, 3210]] = np.radians([0.0, 0.5, -0.3])
    d = diagnose(time, quaternion(attitude * Rotation.from_rotvec(off)))
    assert d.outliers.sample.tolist() == [700, 1500, 1501, 3210]
    size = np.hypot(0.5, 0.3)
    np.testing.assert_allclose(np.degrees(d.outliers.size_rad), size, rtol=0.2)
    if sigma:
        assert d.outliers.sigmas.min() > 10.0


def test_corners_and_jumps_are_not_outliers() -> None:
    time = grid(1000.0)
    for angle in (100 * np.abs(time - 2.0), 5.0 * (time > 2.0), 60 * np.maximum(0.0, time - 1.0) ** 2):
        assert (
            diagnose(time, quaternion(Rotation.from_euler("x", angle[:, None], degrees=True))).outliers.sample.size == 0
        )


def test_body_rate_and_acceleration() -> None:
    time = grid(1000.0)
    d = diagnose(time, quaternion(Rotation.from_euler("z", (30.0 * np.sin(2.0 * time))[:, None], degrees=True)))
    np.testing.assert_allclose(np.degrees(d.body_rate.value), [0.0, 0.0, 60.0], atol=1e-3)
    np.testing.assert_allclose(np.degrees(d.body_acceleration.value), [0.0, 0.0, 120.0], atol=1e-3)
    assert d.body_acceleration.time_s[2] % (np.pi / 2) == pytest.approx(np.pi / 4, abs=2e-3)


@pytest.mark.parametrize("samples", [1, 2, 3, 4, 5, 7, 9, 12])
def test_few_samples(samples: int) -> None:
    time = grid(100.0)[:samples]
    d = diagnose(time, quaternion(truth("manoeuvre", time)))
    nothing_found(d)
    assert d.samples == samples
    assert not d.noise_measured or samples > 12


def test_an_attitude_that_never_changes() -> None:
    time = grid(100.0)
    d = diagnose(time, np.tile([0.5, 0.5, 0.5, 0.5], (time.size, 1)))
    nothing_found(d)
    jittered = time + 1e-3 * np.random.default_rng(0).uniform(size=time.size)
    assert not diagnose(jittered, np.tile([1.0, 0.0, 0.0, 0.0], (time.size, 1))).stamps.explained


def test_a_log_that_changes_its_rate() -> None:
    time = np.concatenate([np.arange(100) / 50.0, 2.0 + np.arange(400) / 200.0])
    nothing_found(diagnose(time, quaternion(truth("manoeuvre", time))))


def test_a_thinned_log_is_uneven_and_has_no_gaps() -> None:
    """Samples written only where the attitude had turned by a degree."""
    time = grid(1000.0)
    attitude = truth("manoeuvre", time)
    kept, last = [0], attitude[0]
    for k in range(1, time.size):
        if (attitude[k] * last.inv()).magnitude() > np.radians(1.0):
            kept.append(k)
            last = attitude[k]
    d = diagnose(time[kept], quaternion(attitude)[kept])
    assert d.gaps == ()
    assert not d.stamps.explained
    assert d.outliers.sample.size == 0


def test_one_gigantic_gap() -> None:
    time = np.concatenate([grid(100.0), 1e9 + grid(100.0)])
    d = diagnose(time, quaternion(truth("gentle", np.concatenate([grid(100.0), 4.01 + grid(100.0)]))))
    assert [(g.start_s, g.end_s) for g in d.gaps] == [(4.0, 1e9)]


def test_signs_of_quaternions_do_not_matter() -> None:
    time = grid(400.0)
    q = quaternion(truth("tumble", time))
    q[::3] *= -1.0
    nothing_found(diagnose(time, q))


def test_seconds_since_1970_are_as_regular_as_doubles() -> None:
    time = grid(100.0)
    d = diagnose(1.7e9 + time, quaternion(truth("manoeuvre", time)))
    assert d.gaps == ()
    assert d.outliers.sample.size == 0
    assert np.degrees(d.white_noise_rad.max()) < 1e-4


def test_the_matrices_of_a_flight_give_the_same() -> None:
    time = grid(400.0)
    attitude = noisy(truth("manoeuvre", time), 0.01)
    by_matrix, by_quaternion = diagnose(time, attitude.inv().as_matrix()), diagnose(time, quaternion(attitude))
    np.testing.assert_allclose(by_matrix.white_noise_rad, by_quaternion.white_noise_rad, rtol=1e-9)


@pytest.mark.parametrize(
    ("time", "attitude"),
    [
        ([], np.empty((0, 4))),
        ([0.0, 1.0], np.eye(4)[:3]),
        ([0.0, 0.0], np.eye(4)[:2]),
        ([0.0, np.nan], np.eye(4)[:2]),
        ([0.0, 1.0], [[1.0, 0.0, 0.0, 0.0], [0.0, 0.0, 0.0, 0.0]]),
        ([0.0, 1.0], [[1.0, 0.0, 0.0, 0.0], [np.nan, 0.0, 0.0, 0.0]]),
    ],
)
def test_what_is_no_flight_is_refused(time: list[float], attitude: list[list[float]]) -> None:
    with pytest.raises(InputError):
        diagnose(time, attitude)
