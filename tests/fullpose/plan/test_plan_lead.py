"""Leads: from rest to the flight and back, with the flight between them, inside every limit."""

from dataclasses import replace

import numpy as np
import pytest

from fullpose.attitude import dcm_from_quaternion
from fullpose.plan import plan
from fullpose.plan.lead import _way, lead_in, lead_out
from fullpose.rig import FrameLimits, Geometry, Rig, builtin_rigs
from fullpose.scenarios import random_flight
from fullpose.verify import verify

DEG = np.pi / 180.0
RIG = builtin_rigs()["vertical-limited"]


def test_the_way_to_rest_has_the_rate_and_acceleration_it_begins_with():
    h = 1e-4
    s = np.arange(0.0, 1.0 + h / 2, h)
    way = _way(s, 2.0, 3.0, 1.0)
    rate = np.diff(way) / h
    acceleration = np.diff(rate) / h
    assert way[0] == 0.0
    assert rate[0] == pytest.approx(2.0, abs=1e-3)
    assert acceleration[0] == pytest.approx(3.0, abs=1e-2)
    assert rate[-1] == pytest.approx(0.0, abs=1e-4)
    assert acceleration[-1] == pytest.approx(0.0, abs=1e-2)
    assert np.abs(np.diff(acceleration)).max() < 0.02  # no jump of the acceleration anywhere


@pytest.mark.parametrize("seed", range(4))
def test_the_whole_motion_from_rest_to_rest_is_inside_the_limits(seed):
    t, q = random_flight(seed, 3.0, 500.0, 100 * DEG)
    made = plan(t, dcm_from_quaternion(q), RIG)
    assert made.verdict.feasible
    assert made.lead_note == ""
    rest = 4
    angles = np.concatenate(
        [
            np.repeat(made.lead_in[:1], rest, axis=0), made.lead_in, made.solution.angles, made.lead_out,
            np.repeat(made.lead_out[-1:], rest, axis=0),
        ]
    )  # fmt: skip
    time = np.arange(len(angles)) * 0.002
    assert verify(time, angles, RIG).violations == ()
    # No corner at the joints: the acceleration changes there by a part of what it may be.
    acceleration = np.diff(angles, 2, axis=0) / 0.002**2
    joint = rest + len(made.lead_in)
    step = np.abs(np.diff(acceleration, axis=0))[joint - 3 : joint + 1].max(axis=0)
    assert (step < 0.5 * RIG.max_acceleration).all()


def test_a_flight_at_rest_needs_no_leads():
    t = np.arange(5) * 0.002
    still = np.tile([0.1, 0.2, 0.3, 0.4], (5, 1))
    assert lead_in(t[:3], still[:3], RIG)[0].shape == (0, 4)
    assert lead_out(t[-3:], still[-3:], RIG)[0].shape == (0, 4)


def test_no_room_is_said_with_frame_and_limit():
    t = np.arange(3) * 0.002
    x = np.zeros((3, 4))
    x[:, 3] = 59.99 * DEG + 300 * DEG * (t - t[-1])
    samples, note = lead_out(t, x, RIG)
    assert samples.shape == (0, 4)
    assert "inner" in note
    assert "position" in note


def test_a_frame_without_an_acceleration_limit_stops_at_once_where_there_is_no_room():
    t = np.arange(3) * 0.002
    x = np.zeros((3, 4))
    x[:, 0] = 100 * DEG * t
    x[:, 3] = 59.99 * DEG + 300 * DEG * (t - t[-1])
    rig = replace(RIG, frames=(*RIG.frames[:3], replace(RIG.frames[3], max_acceleration=np.inf)))
    out, note = lead_out(t, x, rig)
    assert note == ""
    assert (out[:, 3] == x[-1, 3]).all()
    assert out[-1, 0] > x[-1, 0]  # the base has a limit, and brakes
    whole = np.concatenate([x, out, np.repeat(out[-1:], 3, axis=0)])
    assert verify(np.arange(len(whole)) * 0.002, whole, rig).violations == ()
    into, note = lead_in(t, x[::-1], rig)
    assert note == ""
    assert (into[:, 3] == x[-1, 3]).all()


def test_a_stop_at_once_is_no_way_out_of_the_range():
    t = np.arange(3) * 0.002
    x = np.zeros((3, 4))
    x[:, 3] = 61 * DEG + 300 * DEG * (t - t[-1])
    rig = replace(RIG, frames=(*RIG.frames[:3], replace(RIG.frames[3], max_acceleration=np.inf)))
    assert "inner" in lead_out(t, x, rig)[1]


# The first ends on the stop where nothing keeps room for its leads.
@pytest.mark.parametrize(
    ("geometry", "seed"), [(Geometry.VERTICAL_4, 12), (Geometry.VERTICAL_4, 0), (Geometry.HORIZONTAL_4, 2)]
)
def test_a_plan_for_a_rig_without_acceleration_limits_can_be_loaded(geometry, seed):
    free = FrameLimits()
    rig = Rig("inner only", geometry, (free, free, free, FrameLimits(-60 * DEG, 60 * DEG)))
    t, q = random_flight(seed, 3.0, 250.0, 60 * DEG)
    made = plan(t, dcm_from_quaternion(q), rig)
    assert made.ready, made.lead_note
    inner = np.concatenate([made.lead_in[:, 3], made.lead_out[:, 3]])
    assert np.abs(inner).max() <= 60 * DEG
    # There is room left for more than a sudden stop.
    assert len(np.unique(made.lead_out[:, 3])) >= 4
    assert len(np.unique(made.lead_in[:, 3])) >= 4
