"""A recorded flight inside a tolerance, against SciPy's rotations and flights whose truth is known."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from fullpose._typing import Array
from fullpose.attitude import dcm_from_quaternion
from fullpose.errors import InputError
from fullpose.recorded import Smoothed, smooth
from tests.support.recorded import FLIGHTS, geodesic_deg, grid, noisy, quaternion, rounded_angles, truth

SMOOTH = tuple(name for name in FLIGHTS if name != "rest_and_turn")
SIGMAS = (0.001, 0.01, 0.05)


def smoothed(time: Array, attitude: Rotation | Array, tolerance_deg: float | None = None) -> Smoothed:
    q = quaternion(attitude) if isinstance(attitude, Rotation) else attitude
    return smooth(time, dcm_from_quaternion(q), None if tolerance_deg is None else np.radians(tolerance_deg))


def body_acceleration(time: Array, q: Array) -> Array:
    """(n - 2, 3) [deg/s^2] by differences of SciPy's rotation vectors."""
    turned = Rotation.from_quat(q, scalar_first=True)
    rate = (turned[:-1].inv() * turned[1:]).as_rotvec(degrees=True) / np.diff(time)[:, None]
    return np.diff(rate, axis=0) / (0.5 * (time[2:] - time[:-2]))[:, None]


def rms(values: Array) -> float:
    return float(np.sqrt(np.mean(values**2)))


@pytest.mark.parametrize("name", FLIGHTS)
@pytest.mark.parametrize("rate", [50.0, 400.0, 1000.0, 2000.0])
def test_a_clean_flight_is_not_touched(name: str, rate: float) -> None:
    time = grid(rate)
    q = quaternion(truth(name, time))
    made = smoothed(time, q, 0.01)
    assert made.inside
    assert geodesic_deg(made.q, q).max() < 1e-4
    if name != "rest_and_turn":  # whose seventh derivative jumps
        assert made.suggested == 0.0
        np.testing.assert_array_equal(made.deviation, 0.0)
    np.testing.assert_array_equal(made.time, time)


@pytest.mark.parametrize("sigma", SIGMAS)
@pytest.mark.parametrize("name", FLIGHTS)
def test_noise_is_taken_away(name: str, sigma: float) -> None:
    """The suggestion is at most six sigma, a third of the noise is left, and the accelerations are the flight's."""
    time = grid(1000.0, 6.0)
    clean, given = truth(name, time), noisy(truth(name, time), sigma)
    suggestion = np.degrees(smoothed(time, given).suggested)
    assert 4.0 * sigma < suggestion <= 6.0 * sigma
    made = smoothed(time, given, suggestion)
    assert made.inside
    left = geodesic_deg(made.q, quaternion(clean))
    assert rms(left) < 0.35 * rms(geodesic_deg(quaternion(given), quaternion(clean)))
    if name == "spin":
        return  # a quaternion that turns at 1 Hz by itself has more of the noise in its band
    wanted, found = (np.abs(body_acceleration(time, q)).max(axis=0) for q in (quaternion(clean), made.q))
    np.testing.assert_allclose(found, wanted, rtol=0.1, atol=0.1 * wanted.max())


@pytest.mark.parametrize("decimals", [2, 3])
@pytest.mark.parametrize("name", SMOOTH)
def test_decimals_are_taken_away(name: str, decimals: int) -> None:
    time = grid(1000.0, 6.0)
    clean, given = truth(name, time), rounded_angles(truth(name, time), decimals)
    made = smoothed(time, given)
    assert np.degrees(made.suggested) <= 2.0 * 10.0**-decimals
    noise = rms(geodesic_deg(quaternion(given), quaternion(clean)))
    assert rms(geodesic_deg(made.q, quaternion(clean))) < 0.6 * noise


@pytest.mark.parametrize("share", [1.0, 0.97, 0.93, 0.8])
@pytest.mark.parametrize(("name", "sigma"), [("gentle", 0.001), ("manoeuvre", 0.05), ("tumble", 0.01)])
def test_every_sample_is_within_the_tolerance(name: str, sigma: float, share: float) -> None:
    """Wherever it is said to be; and what is said of the deviation is so. Below the floor it is not said."""
    time = grid(500.0)
    given = quaternion(noisy(truth(name, time), sigma))
    free = smoothed(time, given)
    tolerance = share * np.degrees(free.noise) + 1e-12
    made = smoothed(time, given, tolerance)
    away = geodesic_deg(made.q, given)
    np.testing.assert_allclose(np.degrees(made.deviation), away, atol=1e-12)
    assert made.inside == (away.max() <= tolerance)
    assert 0.0 < free.floor < free.noise
    if tolerance > 1.05 * np.degrees(free.floor):
        assert made.inside
    if tolerance < 0.9 * np.degrees(free.floor):
        assert not made.inside
        assert away.max() < np.degrees(free.noise)  # as near as was found


@pytest.mark.parametrize("name", FLIGHTS)
def test_held_samples_are_filled_in(name: str) -> None:
    time = grid(400.0, 6.0)
    clean = quaternion(truth(name, time))
    given = clean[np.arange(time.size) // 8 * 8]
    made = smoothed(time, given)
    assert rms(geodesic_deg(made.q, clean)) < 0.01 * rms(geodesic_deg(given, clean))


def test_a_hold_can_be_followed_later() -> None:
    """A tolerance of six tenths of the holds' error is met by a delay, at the flight's own accelerations."""
    time = grid(400.0, 6.0)
    clean = quaternion(truth("manoeuvre", time))
    given = clean[np.arange(time.size) // 8 * 8]
    free = smoothed(time, given)
    made = smoothed(time, given, 0.6 * np.degrees(free.noise))
    assert made.inside
    assert np.abs(body_acceleration(time, made.q)).max() < 1.3 * np.abs(body_acceleration(time, clean)).max()


@pytest.mark.parametrize("name", SMOOTH)
def test_stamps_that_jitter_are_put_on_their_clock(name: str) -> None:
    time = grid(1000.0)
    stamps = time + np.random.default_rng(0).uniform(-1e-4, 1e-4, time.size)
    clean = quaternion(truth(name, time))
    made = smoothed(stamps, clean)
    np.testing.assert_allclose(np.diff(made.time), 1e-3, atol=1e-7)
    assert made.largest_shift == pytest.approx(1e-4, rel=0.05)
    fastest = np.radians(geodesic_deg(clean[1:], clean[:-1]).max()) * 1000.0
    assert 0.5e-4 * fastest < made.shift_angle <= 1.05e-4 * fastest
    assert made.suggested > made.shift_angle
    assert geodesic_deg(made.q, clean).max() < 1e-9


def test_uneven_stamps_that_are_true() -> None:
    time = np.cumsum(np.random.default_rng(1).uniform(0.5e-3, 1.5e-3, 4000))
    clean, given = truth("manoeuvre", time), noisy(truth("manoeuvre", time), 0.01)
    made = smoothed(time, given)
    np.testing.assert_array_equal(made.time, time)
    assert rms(geodesic_deg(made.q, quaternion(clean))) < 0.004


def test_an_outlier_does_not_bend_the_flight() -> None:
    time = grid(1000.0)
    clean = truth("manoeuvre", time)
    given = quaternion(noisy(clean, 0.01))
    given[1700] = quaternion(clean[1700] * Rotation.from_rotvec([0.0, 0.05, 0.0]))
    made = smoothed(time, given)
    assert np.degrees(made.max_deviation) == pytest.approx(np.degrees(0.05), rel=0.02)
    assert geodesic_deg(made.q, quaternion(clean)).max() < 0.02


def test_another_reference_and_another_unit_of_time() -> None:
    """Turned as the input is turned, and the same in any unit of time."""
    time = grid(1000.0)
    given = noisy(truth("tumble", time), 0.01)
    made = smoothed(time, given)
    turn = Rotation.from_rotvec([0.3, -1.0, 2.0])
    turned = smoothed(time, turn * given)
    expected = quaternion(turn * Rotation.from_quat(made.q, scalar_first=True))
    assert geodesic_deg(turned.q, expected).max() < 1e-6
    slow = smoothed(128.0 * time, given)
    assert geodesic_deg(slow.q, made.q).max() < 1e-6
    assert slow.cut_off_hz == pytest.approx(made.cut_off_hz / 128.0)


def test_many_turns_and_a_slow_log() -> None:
    time = grid(50.0, 120.0)
    clean = truth("spin", time)
    made = smoothed(time, noisy(clean, 0.05))
    assert rms(geodesic_deg(made.q, quaternion(clean))) < 0.05 * np.sqrt(3.0)
    slow = grid(1.0, 300.0)
    clean = truth("gentle", 0.1 * slow)
    made = smoothed(slow, noisy(clean, 0.05))
    assert rms(geodesic_deg(made.q, quaternion(clean))) < 0.05


@pytest.mark.parametrize("samples", [1, 2, 3, 7, 8, 12])
def test_few_samples(samples: int) -> None:
    time = grid(1000.0)[:samples]
    given = noisy(truth("tumble", time), 0.05)
    made = smoothed(time, given, 1.0)
    assert made.inside
    assert made.q.shape == (samples, 4)


def test_a_constant_attitude_with_noise() -> None:
    time = grid(1000.0)
    clean = Rotation.from_rotvec(np.tile([0.4, -0.2, 1.0], (time.size, 1)))
    made = smoothed(time, noisy(clean, 0.01))
    assert geodesic_deg(made.q, quaternion(clean)).max() < 0.01
    assert np.abs(body_acceleration(time, made.q)).max() < 2.0


@pytest.mark.parametrize("tolerance", [0.0, -1.0, np.nan, np.inf, 2.0])
def test_no_tolerance_at_all(tolerance: float) -> None:
    with pytest.raises(InputError, match="tolerance"):
        smooth([0.0, 0.1], np.tile(np.eye(3), (2, 1, 1)), tolerance)
