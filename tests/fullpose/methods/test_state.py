"""The parts that `exact` and `alm` share, each against its definition."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from fullpose._typing import Array
from fullpose.kinematics import jacobian, payload_attitude, rotation_error
from fullpose.limits import limit_table, tolerances
from fullpose.methods.state import (
    CODE,
    GUESS,
    HI,
    INCREMENT,
    LO,
    POSE,
    ROWS,
    TOLERANCE,
    advance,
    give_way,
    goal,
    new_state,
    null_space_increment,
    outermost_code,
    rotate_back,
    settle,
)
from fullpose.rig import FrameLimits, Geometry, Rig, builtin_rigs
from fullpose.solution import EXACT, limited_code
from fullpose.verify import payload_attitudes

RIG = builtin_rigs()["vertical-4"]
LIMITED = limited_code(3, 0)
VECTOR = st.lists(st.floats(-2.0, 2.0), min_size=3, max_size=3).map(np.array)
POSE_ANGLES = st.lists(st.floats(-3.0, 3.0), min_size=4, max_size=4).map(np.array)


@given(VECTOR)
def test_rotate_back_is_undone_by_the_rotation_error(e: Array) -> None:
    C = Rotation.random(random_state=4).as_matrix()
    G = np.empty((3, 3))
    rotate_back(e, C, G)
    np.testing.assert_allclose(G, Rotation.from_rotvec(e).as_matrix().T @ C, atol=1e-14)
    out = np.empty(3)
    angle = rotation_error(G, C, out)
    if np.linalg.norm(e) < 3.0:
        assert angle == pytest.approx(np.linalg.norm(e), abs=1e-12)
        np.testing.assert_allclose(out, e, atol=1e-9)


@given(POSE_ANGLES)
def test_the_increment_follows_its_potentials(d: Array) -> None:
    """Steps up the gradient of avoidance/2 log(m + 0.1) and down the quartic of the end stops, by differences."""
    rig = Rig(
        "test", Geometry.VERTICAL_4, (FrameLimits(-4.0, 4.0), FrameLimits(), FrameLimits(), FrameLimits(-3.0, 5.0))
    )
    table, h, gains = limit_table(rig), 1e-3, np.array([0.7, 1.3, 0.2, 0.5])

    def potential(x: Array) -> float:
        m = np.sin(x[1]) ** 2 + np.cos(x[2]) ** 2
        stops = (x[0] / 4.0) ** 4 * 4.0 / 4.0 + ((x[3] - 1.0) / 4.0) ** 4 * 4.0 / 4.0
        return float(0.35 * np.log(m + 0.1) - 1.3 * stops - 0.1 * np.sum(x**2))

    out = np.empty(4)
    null_space_increment(table, d, h, gains, out)
    step = 1e-6
    for i in range(4):
        ahead, behind = d.copy(), d.copy()
        ahead[i] += step
        behind[i] -= step
        assert out[i] / h == pytest.approx((potential(ahead) - potential(behind)) / (2.0 * step), abs=1e-6)


def aim(off: float, code: int, h: float = 1e-3, recovery: float = 0.5) -> tuple[bool, float]:
    """(whether the goal is the target, error left there [rad]) for a rig `off` [rad] from a target at rest."""
    pose = np.array([0.0, 0.3, 0.2, off])
    C = payload_attitudes(RIG, np.array([[0.0, 0.3, 0.2, 0.0]]))[0]
    F, G, e = np.empty((3, 3)), np.empty((3, 3)), np.empty(3)
    on_target = goal(limit_table(RIG), RIG.axes, new_state(pose, code), C, C, h, recovery, F, G, e)
    return on_target, float(rotation_error(G, C, np.empty(3)))


def test_goal_is_the_target_unless_the_last_sample_was_limited() -> None:
    assert aim(0.5, EXACT) == (True, 0.0)
    assert aim(0.0, LIMITED) == (True, 0.0)
    on_target, left = aim(0.5, LIMITED)
    assert not on_target
    # The way back is at the rate that half of the smallest acceleration (500 deg/s^2) still brakes.
    deceleration = 0.5 * np.radians(500.0)
    assert 0.5 - left == pytest.approx(1e-3 * (np.sqrt(2.0 * deceleration * 0.5) - 0.5e-3 * deceleration), rel=1e-9)


def test_a_small_error_is_closed_at_once() -> None:
    on_target, left = aim(1e-9, LIMITED)
    assert on_target
    assert left == 0.0


def work_for(d: Array, half: float, shift: Array) -> Array:
    work = np.zeros((ROWS, 4))
    work[LO], work[HI] = d + shift - half, d + shift + half
    work[GUESS] = d
    tolerances(limit_table(RIG), 1e-3, 1e-3, work[TOLERANCE])
    return work


@given(POSE_ANGLES, st.integers(0, 2**32 - 1))
def test_settle_finds_a_pose_inside_a_box_that_holds_one(d: Array, seed: int) -> None:
    """The box is laid around another exact pose of the same attitude, a little farther along the curve."""
    if np.sin(d[1]) ** 2 + np.cos(d[2]) ** 2 < 0.05:
        return
    random = np.random.default_rng(seed)
    C = payload_attitudes(RIG, d[None])[0]
    there = work_for(d, np.inf, np.zeros(4))
    there[INCREMENT] = 1e-3 * random.normal(size=4)
    assert settle(False, np.ones(4), d, C, there) > 0
    work = work_for(there[POSE], 1e-6, np.zeros(4))
    work[GUESS] = d
    assert settle(False, np.ones(4), d, C, work) > 0
    assert np.all(np.abs(work[POSE] - there[POSE]) <= 1e-6 + 1e-12)
    assert np.abs(payload_attitudes(RIG, work[POSE][None])[0] - C).max() < 1e-14


def test_settle_says_when_the_box_holds_none() -> None:
    d = np.array([0.1, 0.4, 0.2, -0.3])
    C = payload_attitudes(RIG, d[None])[0]
    work = work_for(d, 1e-6, np.array([1e-3, 1e-3, 1e-3, 1e-3]))
    assert settle(False, np.ones(4), d, C, work) == 0


def test_give_way_goes_as_far_as_it_may_and_names_what_binds() -> None:
    d = np.array([0.0, 0.4, 0.2, 0.0])
    C = payload_attitudes(RIG, np.array([[0.0, 0.4, 0.2, 0.1]]))[0]
    work = work_for(d, 1e-3, np.zeros(4))
    codes = np.array([[limited_code(i, 1) for i in range(4)], [limited_code(i, 2) for i in range(4)]], np.int16)
    J, e, F, A = np.empty((3, 4)), np.empty(3), np.empty((3, 3)), np.empty((4, 5))
    code = give_way(RIG.axes, limit_table(RIG), d, C, J, e, F, work, A, codes[0], codes[1])
    assert code == limited_code(3, 2)
    assert work[GUESS, 3] == d[3] + 1e-3
    assert np.all((work[GUESS] >= work[LO]) & (work[GUESS] <= work[HI]))
    # The least squares of the attitude error, the pose's own Jacobian for a witness: no frame could still lessen it.
    payload_attitude(RIG.axes, work[GUESS], F)
    rotation_error(C, F, e)
    jacobian(RIG.axes, work[GUESS], J)
    downhill = J.T @ e
    for i in range(4):
        at_bound = work[GUESS, i] in (work[LO, i], work[HI, i])
        assert at_bound or abs(downhill[i]) < 1e-6


def test_outermost_code() -> None:
    lo, hi = -np.ones(4), np.ones(4)
    codes = np.arange(1, 5, dtype=np.int16), np.arange(11, 15, dtype=np.int16)
    assert outermost_code(np.array([0.0, 1.5, -1.2, 0.0]), lo, hi, *codes) == 12
    assert outermost_code(np.array([0.0, 1.1, -1.2, 0.0]), lo, hi, *codes) == 3


def test_advance_keeps_rate_interval_and_target() -> None:
    state, target = new_state(np.zeros(4), EXACT), np.eye(3)
    C = Rotation.random(random_state=2).as_matrix()
    advance(state, target, 1.0, np.zeros(4), EXACT, C)
    advance(state, target, 1.5, np.full(4, 0.25), LIMITED, C)
    np.testing.assert_array_equal(state[:4], 0.25)
    np.testing.assert_array_equal(state[4:8], 0.5)
    assert state[CODE] == LIMITED
    np.testing.assert_array_equal(target, C)
