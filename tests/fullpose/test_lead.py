"""Leads: rest at one end, the path's own motion at the other, inside every limit on the way."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from fullpose._typing import Array
from fullpose.lead import EDGES, braking, lead_in, lead_out
from fullpose.rig import FrameLimits, Geometry, Rig, builtin_rigs
from fullpose.verify import differences, verify

DEG = np.pi / 180.0
RIGS = builtin_rigs()
RIG = RIGS["vertical-limited"]
DT = 1e-3
SHARE = st.lists(st.floats(-0.9, 0.9), min_size=4, max_size=4).map(np.array)


@pytest.mark.parametrize("edge", EDGES)
def test_the_way_to_rest_has_the_rate_and_acceleration_it_begins_with(edge: float) -> None:
    h = 1e-4
    s = np.arange(0.0, 1.0 + h / 2, h)
    way = braking(s, 2.0, 3.0, 1.0, edge)
    rate = np.diff(way) / h
    acceleration = np.diff(rate) / h
    assert way[0] == 0.0
    assert rate[0] == pytest.approx(2.0, abs=1e-3)
    assert acceleration[0] == pytest.approx(3.0, abs=1e-2)
    assert rate[-1] == pytest.approx(0.0, abs=1e-4)
    assert acceleration[-1] == pytest.approx(0.0, abs=1e-2)
    assert np.abs(np.diff(acceleration)).max() < 0.005 / edge  # no jump of the acceleration anywhere


def motion(position: Array, rate: Array, acceleration: Array) -> tuple[Array, Array]:
    """(time (3,), angles (3, 4)) of a path that begins so."""
    t = DT * np.arange(3)
    return t, position + np.outer(t, rate) + 0.5 * np.outer(t**2, acceleration)


@given(rate=SHARE, acceleration=SHARE, position=SHARE)
def test_from_rest_into_motion_and_back(rate: Array, acceleration: Array, position: Array) -> None:
    rig = RIGS["vertical-4"]
    v, a = rate * rig.max_rate, 0.9 * acceleration * rig.max_acceleration
    t, x = motion(position, v, a)
    assume(bool((np.abs(x[2] - x[1]) < rig.max_rate * DT).all()))
    lead = lead_in(t, x, rig)
    assert lead.refusal == ""
    path = np.vstack([lead.angles[:1], lead.angles[:1], lead.angles, x]) if len(lead.angles) else x
    assert verify(np.arange(len(path)) * DT, path, rig).violations == ()
    # Continuous at the joint: no step in acceleration from one sample to the next but the path's own curve.
    if len(path) > 6:
        _, accelerations = differences(np.arange(len(path)) * DT, path)
        assert np.all(np.abs(np.diff(accelerations[-4:], axis=0)) <= 0.05 * rig.max_acceleration)
        assert np.all(np.abs(accelerations[-2:] - a) <= 0.05 * rig.max_acceleration)
    # The lead-out of the mirrored motion is the mirrored lead-in.
    np.testing.assert_array_equal(lead_out(-t[::-1], x[::-1], rig).angles[::-1], lead.angles)


def test_frames_that_need_less_time_rest_first() -> None:
    t, x = motion(np.zeros(4), np.array([0.1, 0.0, 3.0, 0.0]), np.zeros(4))
    lead = lead_in(t, x, RIGS["vertical-4"]).angles
    assert np.all(lead[:, 1] == 0.0)
    assert np.all(lead[:10, 0] == lead[0, 0])
    assert lead[10, 2] != lead[0, 2]


def test_a_three_axis_rig_keeps_its_absent_base() -> None:
    t, x = motion(np.zeros(4), np.array([0.0, 1.0, 0.0, 0.0]), np.zeros(4))
    lead = lead_in(t, x, RIGS["vertical-3"]).angles
    assert len(lead) > 0
    assert np.all(lead[:, 0] == 0.0)


@pytest.mark.parametrize(("room", "fits"), [(0.9, True), (0.6, True), (0.54, True), (0.48, False)])
def test_little_room_takes_the_tight_profile_and_none_is_refused(room: float, fits: bool) -> None:
    """`room` in v^2 / a: half of it is what braking takes at the least."""
    frame = FrameLimits(-1.0, 1.0, 5.0, 10.0)
    rig = Rig("small", Geometry.VERTICAL_4, (frame, frame, frame, frame))
    rate = 3.0
    t, x = motion(np.zeros(4), np.array([rate, 0.0, 0.0, 0.0]), np.zeros(4))
    x[:, 0] += 1.0 - room * rate**2 / 10.0 - x[-1, 0]
    lead = lead_out(t, x, rig)
    assert (lead.refusal == "") == fits
    if fits:
        assert lead.angles[-1, 0] <= 1.0
    else:
        assert "base frame's position" in lead.refusal


def test_a_flight_at_rest_needs_no_leads() -> None:
    t = np.arange(5) * 0.002
    still = np.tile([0.1, 0.2, 0.3, 0.4], (5, 1))
    assert lead_in(t[:3], still[:3], RIG).angles.shape == (0, 4)
    assert lead_out(t[-3:], still[-3:], RIG).angles.shape == (0, 4)


def test_no_room_is_said_with_frame_and_limit() -> None:
    t = np.arange(3) * 0.002
    x = np.zeros((3, 4))
    x[:, 3] = 59.99 * DEG + 300 * DEG * (t - t[-1])
    lead = lead_out(t, x, RIG)
    assert lead.angles.shape == (0, 4)
    assert "inner frame's position" in lead.refusal


def test_a_frame_without_an_acceleration_limit_stops_at_once_where_there_is_no_room() -> None:
    t = np.arange(3) * 0.002
    x = np.zeros((3, 4))
    x[:, 0] = 100 * DEG * t
    x[:, 3] = 59.99 * DEG + 300 * DEG * (t - t[-1])
    rig = replace(RIG, frames=(*RIG.frames[:3], replace(RIG.frames[3], max_acceleration=np.inf)))
    lead = lead_out(t, x, rig)
    assert lead.refusal == ""
    out = lead.angles
    assert (out[:, 3] == x[-1, 3]).all()
    assert out[-1, 0] > x[-1, 0]  # the base has a limit, and brakes
    whole = np.concatenate([x, out, np.repeat(out[-1:], 3, axis=0)])
    assert verify(np.arange(len(whole)) * 0.002, whole, rig).violations == ()
    into = lead_in(t, x[::-1], rig)
    assert into.refusal == ""
    assert (into.angles[:, 3] == x[-1, 3]).all()


def test_a_stop_at_once_is_no_way_out_of_the_range() -> None:
    t = np.arange(3) * 0.002
    x = np.zeros((3, 4))
    x[:, 3] = 61 * DEG + 300 * DEG * (t - t[-1])
    rig = replace(RIG, frames=(*RIG.frames[:3], replace(RIG.frames[3], max_acceleration=np.inf)))
    assert "inner" in lead_out(t, x, rig).refusal
