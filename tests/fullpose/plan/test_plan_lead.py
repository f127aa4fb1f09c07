"""Leads of plans: from rest to the flight and back, with the flight between them, inside every limit."""

import numpy as np
import pytest

from fullpose.attitude import dcm_from_quaternion
from fullpose.plan import plan
from fullpose.rig import FrameLimits, Geometry, Rig, builtin_rigs
from fullpose.scenarios import random_flight
from fullpose.verify import verify

DEG = np.pi / 180.0
RIG = builtin_rigs()["vertical-limited"]


@pytest.mark.parametrize("seed", range(4))
def test_the_whole_motion_from_rest_to_rest_is_inside_the_limits(seed):
    t, q = random_flight(seed, 3.0, 500.0, 100 * DEG)
    made = plan(t, dcm_from_quaternion(q), RIG)
    assert made.verdict.feasible
    assert made.lead_refusal == ""
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


# The first ends on the stop where nothing keeps room for its leads.
@pytest.mark.parametrize(
    ("geometry", "seed"), [(Geometry.VERTICAL_4, 12), (Geometry.VERTICAL_4, 0), (Geometry.HORIZONTAL_4, 2)]
)
def test_a_plan_for_a_rig_without_acceleration_limits_can_be_loaded(geometry, seed):
    free = FrameLimits()
    rig = Rig("inner only", geometry, (free, free, free, FrameLimits(-60 * DEG, 60 * DEG)))
    t, q = random_flight(seed, 3.0, 250.0, 60 * DEG)
    made = plan(t, dcm_from_quaternion(q), rig)
    assert made.ready, made.lead_refusal
    inner = np.concatenate([made.lead_in[:, 3], made.lead_out[:, 3]])
    assert np.abs(inner).max() <= 60 * DEG
    # There is room left for more than a sudden stop.
    assert len(np.unique(made.lead_out[:, 3])) >= 4
    assert len(np.unique(made.lead_in[:, 3])) >= 4
