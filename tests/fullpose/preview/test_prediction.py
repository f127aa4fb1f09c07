"""The attitude to come: known, interpolated, predicted; each against a motion that is known exactly."""

import numpy as np
import pytest

from fullpose.attitude import dcm_from_quaternion
from fullpose.errors import InputError
from fullpose.preview.prediction import Track, attitudes_ahead, body_motion
from fullpose.verify import attitude_errors


def constant_rotation(rate, acceleration, time):
    """C(t) about one axis, so that the rate and acceleration are exact."""
    axis = np.asarray(rate) / np.linalg.norm(rate)
    angle = np.linalg.norm(rate) * time + 0.5 * (acceleration @ axis) * time**2
    half = 0.5 * angle[:, None]
    return dcm_from_quaternion(np.hstack([np.cos(half), np.sin(half) * axis]))


def test_body_motion_from_samples() -> None:
    rate, acceleration = np.array([0.3, -0.8, 0.5]), 0.7 * np.array([0.3, -0.8, 0.5])
    time = np.linspace(-0.15, 0.0, 31)
    attitude = constant_rotation(rate, acceleration, time)
    w, a = np.empty(3), np.empty(3)
    body_motion(time, attitude, 0.1, w, a)
    assert np.allclose(w, rate, atol=1e-6)
    assert np.allclose(a, acceleration, atol=1e-4)
    body_motion(time[-1:], attitude[-1:], 0.1, w, a)
    assert not w.any()
    assert not a.any()
    body_motion(time[-2:], attitude[-2:], 0.1, w, a)
    assert np.allclose(w, rate, atol=3e-3)


def test_jitter_is_averaged() -> None:
    random = np.random.default_rng(1)
    time = np.arange(-0.15, 1e-9, 0.005)
    true = np.array([0.0, 1.0, 0.0])
    attitude = constant_rotation(true, np.zeros(3), time + 1e-4 * random.normal(size=len(time)))  # 1e-4 rad
    w, a = np.empty(3), np.empty(3)
    body_motion(time, attitude, 0.1, w, a)
    assert np.linalg.norm(w - true) < 0.02


def test_known_attitudes_are_interpolated_and_the_rest_predicted() -> None:
    rate = np.array([0.2, 0.9, -0.4])
    time = np.linspace(0.0, 1.0, 51)
    attitude = constant_rotation(rate, np.zeros(3), time)
    ahead = np.array([0.503, 0.777, 1.0, 1.1, 1.4, 2.0])
    out = np.empty((6, 3, 3))
    assert attitudes_ahead(time, attitude, ahead, 0.1, 0.3, 0.0, out) == 3
    error, _ = attitude_errors(out, constant_rotation(rate, np.zeros(3), ahead))
    assert error.max() < 1e-9


def test_an_acceleration_dies_away() -> None:
    rate, acceleration, settling = np.array([0.0, 1.0, 0.0]), np.array([0.0, 2.0, 0.0]), 0.3
    time = np.linspace(-0.2, 0.0, 41)
    ahead = np.array([0.2, 0.5, 1.0])
    out = np.empty((3, 3, 3))
    attitudes_ahead(time, constant_rotation(rate, acceleration, time), ahead, 0.1, settling, 0.0, out)
    turned = ahead + 2.0 * settling * (ahead - settling * (1.0 - np.exp(-ahead / settling)))
    half = 0.5 * turned[:, None]
    expected = dcm_from_quaternion(np.hstack([np.cos(half), np.sin(half) * np.array([0.0, 1.0, 0.0])]))
    error, _ = attitude_errors(out, expected)
    assert error.max() < 1e-4


def test_a_track_keeps_what_is_newest_and_takes_back_what_was_foretold() -> None:
    track = Track(0.2)
    eye = np.eye(3)
    for k in range(100):
        track.flown(0.001 * k, eye)
    assert track.end == pytest.approx(0.099)
    assert len(track.copy()[0]) < 30  # thinned
    ahead = 0.1 + 0.01 * np.arange(100)
    track.tell(ahead, np.tile(eye, (100, 1, 1)))
    turned = np.diag([1.0, -1.0, -1.0])
    track.tell(np.array([0.5, 0.6]), np.tile(turned, (2, 1, 1)))
    time, attitude = track.copy()
    assert track.end == 0.6
    assert np.all(np.diff(time) > 0.0)
    assert np.array_equal(attitude[-1], turned)
    assert np.array_equal(attitude[time < 0.45][-1], eye)
    track.forget(0.55)
    assert track.copy()[0][0] <= 0.37
    assert track.copy()[0][0] > 0.3
    with pytest.raises(InputError):
        track.tell(np.array([1.0, 1.0]), np.tile(eye, (2, 1, 1)))
