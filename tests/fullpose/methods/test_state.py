"""What the methods that keep limits share, each against its definition."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from fullpose._typing import Array
from fullpose.bounds import EXACT, limited_code
from fullpose.kinematics import jacobian, payload_attitude, rotation_error
from fullpose.limits import tolerances
from fullpose.methods.limited import goal, null_space_increment, outermost_code, settle, yield_attitude
from fullpose.methods.state import Flight, advance, new_flight
from fullpose.rig import FrameLimits, Geometry, Rig, builtin_rigs
from fullpose.verify import payload_attitudes

RIG = builtin_rigs()["vertical-4"]
LIMITED = limited_code(3, 0)
POSE_ANGLES = st.lists(st.floats(-3.0, 3.0), min_size=4, max_size=4).map(np.array)


@given(POSE_ANGLES)
def test_the_increment_follows_its_potentials(d: Array) -> None:
    """Steps up the gradient of avoidance/2 log(m + 0.1) and down the quartic of the end stops, by differences."""
    rig = Rig(
        "test", Geometry.VERTICAL_4, (FrameLimits(-4.0, 4.0), FrameLimits(), FrameLimits(), FrameLimits(-3.0, 5.0))
    )
    h = 1e-3
    flight = new_flight(rig, d, EXACT, np.eye(3))
    flight.avoidance, flight.centring, flight.homing, flight.ahead = 0.7, 1.3, 0.2, h

    def potential(x: Array) -> float:
        m = np.sin(x[1]) ** 2 + np.cos(x[2]) ** 2
        stops = (x[0] / 4.0) ** 4 * 4.0 / 4.0 + ((x[3] - 1.0) / 4.0) ** 4 * 4.0 / 4.0
        return float(0.35 * np.log(m + 0.1) - 1.3 * stops - 0.1 * np.sum(x**2))

    null_space_increment(flight)
    step = 1e-6
    for i in range(4):
        ahead, behind = d.copy(), d.copy()
        ahead[i] += step
        behind[i] -= step
        assert flight.increment[i] / h == pytest.approx((potential(ahead) - potential(behind)) / (2.0 * step), abs=1e-6)


def aim(off: float, code: int, h: float = 1e-3, recovery: float = 0.5) -> tuple[bool, float]:
    """(whether the goal is the target, error left there [rad]) for a rig `off` [rad] from a target at rest."""
    pose = np.array([0.0, 0.3, 0.2, off])
    C = payload_attitudes(RIG, np.array([[0.0, 0.3, 0.2, 0.0]]))[0]
    flight = new_flight(RIG, pose, code, C)
    flight.ahead, flight.recovery = h, recovery
    goal(flight, C)
    return bool(flight.on_target), float(rotation_error(flight.goal.copy(), C, np.empty(3)))


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


def flight_for(d: Array, half: float, shift: Array, C: Array) -> Flight:
    """A flight at d, of unit weights, for C, with a box of that half width around d + shift."""
    flight = new_flight(RIG, d, EXACT, C)
    flight.lo[:], flight.hi[:] = d + shift - half, d + shift + half
    flight.guess[:], flight.goal[:] = d, C
    tolerances(flight.limits.copy(), 1e-3, 1e-3, flight.tolerance)
    return flight


@given(POSE_ANGLES, st.integers(0, 2**32 - 1))
def test_settle_finds_a_pose_inside_a_box_that_holds_one(d: Array, seed: int) -> None:
    """The box is laid around another exact pose of the same attitude, a little farther along the curve."""
    if np.sin(d[1]) ** 2 + np.cos(d[2]) ** 2 < 0.05:
        return
    random = np.random.default_rng(seed)
    C = payload_attitudes(RIG, d[None])[0]
    there = flight_for(d, np.inf, np.zeros(4), C)
    there.increment[:] = 1e-3 * random.normal(size=4)
    assert settle(there) > 0
    flight = flight_for(there.next.copy(), 1e-6, np.zeros(4), C)
    flight.pose[:] = flight.guess[:] = d
    assert settle(flight) > 0
    assert np.all(np.abs(flight.next - there.next) <= 1e-6 + 1e-12)
    assert np.abs(payload_attitudes(RIG, flight.next[None])[0] - C).max() < 1e-14


def test_settle_says_when_the_box_holds_none() -> None:
    d = np.array([0.1, 0.4, 0.2, -0.3])
    C = payload_attitudes(RIG, d[None])[0]
    assert settle(flight_for(d, 1e-6, np.array([1e-3, 1e-3, 1e-3, 1e-3]), C)) == 0


def test_yield_attitude_goes_as_far_as_it_may_and_names_what_binds() -> None:
    d = np.array([0.0, 0.4, 0.2, 0.0])
    C = payload_attitudes(RIG, np.array([[0.0, 0.4, 0.2, 0.1]]))[0]
    flight = flight_for(d, 1e-3, np.zeros(4), C)
    flight.lo_code[:], flight.hi_code[:] = (
        [limited_code(i, 1) for i in range(4)],
        [limited_code(i, 2) for i in range(4)],
    )
    assert yield_attitude(flight) == limited_code(3, 2)
    guess = flight.guess.copy()
    assert guess[3] == d[3] + 1e-3
    assert np.all((guess >= flight.lo) & (guess <= flight.hi))
    # The least squares of the attitude error, the pose's own Jacobian for a witness: no frame could still lessen it.
    F, e, J = np.empty((3, 3)), np.empty(3), np.empty((3, 4))
    payload_attitude(RIG.axes, guess, F)
    rotation_error(C, F, e)
    jacobian(RIG.axes, guess, J)
    downhill = J.T @ e
    for i in range(4):
        at_bound = guess[i] in (flight.lo[i], flight.hi[i])
        assert at_bound or abs(downhill[i]) < 1e-6


def test_outermost_code() -> None:
    flight = new_flight(RIG, np.zeros(4), EXACT, np.eye(3))
    flight.lo[:], flight.hi[:] = -1.0, 1.0
    flight.lo_code[:], flight.hi_code[:] = range(1, 5), range(11, 15)
    assert outermost_code(flight, np.array([0.0, 1.5, -1.2, 0.0])) == 12
    assert outermost_code(flight, np.array([0.0, 1.1, -1.2, 0.0])) == 3


def test_advance_keeps_rate_interval_and_target() -> None:
    flight = new_flight(RIG, np.zeros(4), EXACT, np.eye(3))
    C = Rotation.random(random_state=2).as_matrix()
    flight.next[:] = 0.0
    advance(flight, 1.0, EXACT, C)
    flight.next[:] = 0.25
    advance(flight, 1.5, LIMITED, C)
    np.testing.assert_array_equal(flight.pose, 0.25)
    np.testing.assert_array_equal(flight.rate, 0.5)
    assert flight.past == 0.5
    assert flight.code == LIMITED
    np.testing.assert_array_equal(flight.target, C)
