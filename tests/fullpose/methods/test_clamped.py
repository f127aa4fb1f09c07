"""Clamping weighted least norm."""

import numpy as np
import pytest

from fullpose.attitude import dcm_from_quaternion
from fullpose.bounds import limited_name
from fullpose.kinematics import jacobian, null_vector
from fullpose.methods.clamped import LOCKS, METHOD, ClampedOptions, Locks, clamped_step
from fullpose.rig import FrameLimits, Geometry, Rig, builtin_rigs
from fullpose.scenarios import SCENARIOS
from fullpose.solve import solve
from fullpose.verify import verify

RIGS = builtin_rigs()


def step(J: np.ndarray, e: np.ndarray, lo: np.ndarray, hi: np.ndarray) -> tuple[np.ndarray, np.ndarray, int]:
    locks: Locks = np.zeros(1, LOCKS)[0]
    locks.minors[:], locks.lo[:], locks.hi[:] = np.inf, lo, hi
    first = clamped_step(J, null_vector(J, np.empty(4)), np.ones(4), e, locks)
    return locks.step.copy(), locks.free.astype(bool), first


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


def test_a_mark_ends_when_the_attitude_is_back() -> None:
    """A coarse tolerance leaves an error in every sample, which is no limit's doing."""
    scenario = SCENARIOS["over_limit"]
    C = dcm_from_quaternion(scenario.quaternion)

    def limited(tolerance: float) -> np.ndarray:
        return solve(scenario.time, C, RIGS["vertical-limited"], "clamped", ClampedOptions(tolerance=tolerance)).limited

    fine, coarse = limited(1e-14), limited(1e-6)
    assert np.count_nonzero(coarse) == pytest.approx(np.count_nonzero(fine), rel=0.05)
    assert coarse[-1] == 0


def test_every_sample_beyond_a_billionth_of_a_degree_is_marked() -> None:
    scenario = SCENARIOS["level"]
    solution = solve(scenario.time, dcm_from_quaternion(scenario.quaternion), RIGS["vertical-4"], "clamped")
    missed = solution.error > np.deg2rad(1e-9)
    assert missed.any()
    np.testing.assert_array_equal(solution.limited > 0, missed)


@pytest.mark.parametrize("name", ["large_no_limit", "level"])
def test_the_pole_of_the_frames_left_is_passed(name: str) -> None:
    """The base is locked; the others are free, and meet their own pole in mid flight."""
    scenario = SCENARIOS[name]
    free = FrameLimits()
    rig = Rig("locked", Geometry.VERTICAL_4, (FrameLimits(0.0, 0.0), free, free, free))
    solution = solve(scenario.time, dcm_from_quaternion(scenario.quaternion), rig, "clamped")
    assert solution.limited_samples == 0
    assert solution.error.max() < np.deg2rad(1e-9)
    assert np.abs(solution.angles).max() < 10.0
