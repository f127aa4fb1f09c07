"""Leads: rest at one end, the path's own motion at the other, inside every limit on the way."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray

from fullpose.errors import InputError, MethodError
from fullpose.lead import lead_in, lead_out
from fullpose.rig import FrameLimits, Geometry, Rig, builtin_rigs
from fullpose.verify import differences, verify

RIGS = builtin_rigs()
DT = 1e-3
SHARE = st.lists(st.floats(-0.9, 0.9), min_size=4, max_size=4).map(np.array)


@given(rate=SHARE, acceleration=SHARE, position=SHARE)
def test_from_rest_into_motion_and_back(
    rate: NDArray[np.float64], acceleration: NDArray[np.float64], position: NDArray[np.float64]
) -> None:
    rig = RIGS["vertical-4"]
    v, a = rate * rig.max_rate, 0.9 * acceleration * rig.max_acceleration
    lead = lead_in(rig, position, v, a, DT)
    joint = np.array([position, position + v * DT + 0.5 * a * DT**2])
    path = np.vstack([lead[:1], lead[:1], lead, joint]) if len(lead) else joint
    assert verify(np.arange(len(path)) * DT, path, rig).violations == ()
    # Continuous at the joint: no step in acceleration from one sample to the next but the path's own curve.
    if len(path) > 6:
        _, accelerations = differences(np.arange(len(path)) * DT, path)
        jump = np.abs(np.diff(accelerations[-4:], axis=0)).max(axis=0)
        assert np.all(jump <= 0.05 * rig.max_acceleration)
        assert np.all(np.abs(accelerations[-1] - a) <= 0.05 * rig.max_acceleration)
    # The lead-out of the mirrored motion is the mirrored lead-in.
    np.testing.assert_array_equal(lead_out(rig, position, -v, a, DT)[::-1], lead)


def test_a_path_at_rest_needs_no_lead() -> None:
    assert lead_in(RIGS["vertical-4"], np.ones(4), np.zeros(4), np.zeros(4), DT).shape == (0, 4)


def test_frames_that_need_less_time_rest_first() -> None:
    rate = np.array([0.1, 0.0, 3.0, 0.0])
    lead = lead_in(RIGS["vertical-4"], np.zeros(4), rate, np.zeros(4), DT)
    assert np.all(lead[:, 1] == 0.0)
    assert np.all(lead[:10, 0] == lead[0, 0])
    assert lead[10, 2] != lead[0, 2]


def test_a_three_axis_rig_keeps_its_absent_base() -> None:
    lead = lead_in(RIGS["vertical-3"], np.zeros(4), np.array([0.0, 1.0, 0.0, 0.0]), np.zeros(4), DT)
    assert np.all(lead[:, 0] == 0.0)


def test_little_room_takes_the_tight_profile_and_none_is_refused() -> None:
    frame = FrameLimits(-1.0, 1.0, 5.0, 10.0)
    rig = Rig("small", Geometry.VERTICAL_4, (frame, frame, frame, frame))
    still = np.zeros(4)
    # Braking from 3 rad/s takes 0.45 rad, a cubic 0.675.
    lead = lead_out(rig, np.array([0.45, 0.0, 0.0, 0.0]), np.array([3.0, 0.0, 0.0, 0.0]), still, DT)
    assert lead[-1, 0] <= 1.0
    with pytest.raises(MethodError, match=r"base frame.*position"):
        lead_out(rig, np.array([0.9, 0.0, 0.0, 0.0]), np.array([3.0, 0.0, 0.0, 0.0]), still, DT)


def test_bad_numbers_are_refused() -> None:
    rig = RIGS["vertical-4"]
    with pytest.raises(InputError):
        lead_in(rig, np.full(4, np.nan), np.zeros(4), np.zeros(4), DT)
    with pytest.raises(InputError):
        lead_in(rig, np.zeros(4), np.zeros(3), np.zeros(4), DT)
    with pytest.raises(InputError):
        lead_in(rig, np.zeros(4), np.ones(4), np.zeros(4), 0.0)
