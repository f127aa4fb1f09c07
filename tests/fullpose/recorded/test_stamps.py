"""Stamps, steps and gaps of recorded flights: which clock explains them, and which are as they were recorded."""

import numpy as np
import pytest

from fullpose.recorded import diagnose
from tests.support.recorded import FLIGHTS, grid, noisy, quaternion, truth


@pytest.mark.parametrize("name", [n for n in FLIGHTS if n != "rest_and_turn"])
def test_rounded_stamps_are_explained(name: str) -> None:
    time = grid(400.0)
    d = diagnose(np.round(time, 3), quaternion(truth(name, time)))
    assert d.stamps.explained
    assert d.stamps.quantum_s == 0.001
    assert d.stamps.regular_time_s is not None
    np.testing.assert_allclose(np.diff(d.stamps.regular_time_s), 0.0025, rtol=1e-6)
    assert d.stamps.jitter_max_s == pytest.approx(0.0005, rel=0.01)
    assert d.gaps == ()
    assert d.outliers.sample.size == 0


@pytest.mark.parametrize("rate", [500.0 / 0.6, 900.0, 666.0])
def test_rounded_stamps_are_not_dropped_samples(rate: float) -> None:
    """At 900 Hz in milliseconds every tenth step is twice as long."""
    time = grid(rate)
    d = diagnose(np.round(time, 3), quaternion(truth("manoeuvre", time)))
    assert d.stamps.explained
    assert d.gaps == ()
    assert d.median_step_s == pytest.approx(1.0 / rate, rel=5e-5)


@pytest.mark.parametrize("name", [n for n in FLIGHTS if n != "rest_and_turn"])
def test_jittered_stamps_are_explained(name: str) -> None:
    time = grid(1000.0)
    jitter = 1e-4 * np.random.default_rng(0).normal(size=time.size)
    d = diagnose(time + jitter, quaternion(truth(name, time)))
    assert d.stamps.explained
    assert d.stamps.quantum_s == 0.0
    assert d.stamps.jitter_rms_s == pytest.approx(1e-4, rel=0.05)
    assert d.gaps == ()
    assert d.near_duplicates.size == 0


def test_jittered_stamps_with_noise_beside_them() -> None:
    time = grid(1000.0)
    jitter = 1e-4 * np.random.default_rng(0).normal(size=time.size)
    d = diagnose(time + jitter, quaternion(noisy(truth("manoeuvre", time), 0.002)))
    assert d.stamps.explained
    np.testing.assert_allclose(np.degrees(d.white_noise_rad), 0.002, rtol=0.15)


@pytest.mark.parametrize("name", FLIGHTS)
def test_samples_taken_at_uneven_times_have_no_clock(name: str) -> None:
    """The attitude agrees with the stamps: they are right."""
    time = grid(1000.0) + 2e-4 * np.random.default_rng(0).uniform(-1.0, 1.0, 4001)
    d = diagnose(time, quaternion(truth(name, time)))
    assert not d.stamps.explained
    assert d.stamps.jitter_rms_s > 5e-5
    np.testing.assert_array_equal(d.white_noise_rad, 0.0)
    assert d.gaps == ()
    assert d.outliers.sample.size == 0


def test_one_stamp_beside_its_neighbour_is_told_from_a_sample_too_many() -> None:
    time = grid(100.0)
    q = quaternion(truth("manoeuvre", time))
    moved = time.copy()
    moved[50] = moved[49] + 1e-6
    d = diagnose(moved, q)
    assert d.near_duplicates.tolist() == [50]
    assert d.stamps.explained
    assert d.gaps == ()
    more = np.insert(time, 50, time[49] + 1e-6)
    d = diagnose(more, np.insert(q, 50, q[49], axis=0))
    assert d.near_duplicates.tolist() == [50]
    assert not d.stamps.explained
    assert d.gaps == ()


@pytest.mark.parametrize("name", FLIGHTS)
def test_gaps_are_exact(name: str) -> None:
    time = grid(200.0)
    kept = np.ones(time.size, bool)
    kept[[100, 300, 301]] = False
    kept[501:551] = False
    d = diagnose(time[kept], quaternion(truth(name, time))[kept])
    assert [(g.start_s, g.end_s) for g in d.gaps] == [(0.495, 0.505), (1.495, 1.51), (2.5, 2.755)]
    np.testing.assert_allclose([g.steps for g in d.gaps], [2.0, 3.0, 51.0], rtol=1e-9)
    assert d.outliers.sample.size == 0
    assert not d.stamps.explained
    np.testing.assert_array_equal(d.white_noise_rad, 0.0)
