"""Clamping weighted least norm."""

import numpy as np
import pytest

from solver.attitude import dcm_from_quaternion
from solver.kinematics import jacobian, null_vector
from solver.methods.clamped import METHOD, ClampedOptions, clamped_step
from solver.rig import builtin_rigs
from solver.scenarios import SCENARIOS
from solver.solution import limited_name
from solver.verify import verify

RIGS = builtin_rigs()


def step(J: np.ndarray, e: np.ndarray, lo: np.ndarray, hi: np.ndarray) -> tuple[np.ndarray, np.ndarray, int]:
    p, free, room, n = np.empty(4), np.empty(4, bool), np.empty((3, 4)), np.empty(4)
    first = clamped_step(J, null_vector(J, n), np.ones(4), e, lo, hi, free, room, p)
    return p, free, first


def random_jacobian(random: np.random.Generator) -> np.ndarray:
    J = np.empty((3, 4))
    jacobian(RIGS["vertical-4"].axes, random.uniform(-1.0, 1.0, 4), J)
    return J


def test_without_bounds_it_is_the_pseudo_inverse() -> None:
    random = np.random.default_rng(0)
    for _ in range(50):
        J, e = random_jacobian(random), random.normal(size=3)
        p, free, first = step(J, e, np.full(4, -np.inf), np.full(4, np.inf))
        np.testing.assert_allclose(p, np.linalg.pinv(J) @ e, atol=1e-12)
        assert free.all()
        assert first == 0


def test_locked_frames_are_on_their_bounds_and_the_others_re_solved() -> None:
    random = np.random.default_rng(1)
    locked_once = 0
    for _ in range(300):
        J, e = random_jacobian(random), random.normal(size=3)
        hi = random.uniform(0.05, 1.5, 4)
        p, free, first = step(J, e, -hi, hi)
        assert np.all(np.abs(p) <= hi)
        np.testing.assert_array_equal(np.abs(p[~free]), hi[~free])
        if free.any():
            rest = e - J[:, ~free] @ p[~free]
            np.testing.assert_allclose(p[free], np.linalg.pinv(J[:, free], rcond=1e-9) @ rest, atol=1e-7)
        if np.count_nonzero(~free) == 1:
            locked_once += 1
            np.testing.assert_allclose(J @ p, e, atol=1e-10)  # three frames left: the attitude is held
        if first:
            frame = (first - 1) // 2
            assert not free[frame]
            assert p[frame] == (hi if first % 2 == 0 else -hi)[frame]
    assert locked_once > 20


def test_the_mark_names_the_limit() -> None:
    scenario = SCENARIOS["over_limit_small_pitch"]
    rig = RIGS["vertical-limited"]
    C = dcm_from_quaternion(scenario.quaternion)
    block = METHOD.stepper(rig, ClampedOptions(), None, C[0]).block(scenario.time, C)
    first = int(np.flatnonzero(block.limited)[0])
    assert limited_name(int(block.limited[first])) is not None
    before = verify(scenario.time[:first], block.angles[:first], rig, C[:first])
    assert before.max_error < 1e-9
    assert abs(block.angles[first, 3]) == pytest.approx(np.deg2rad(60.0), abs=0.05)
