"""Plans that must fly a flight exactly, as code apart from the planner sees it."""

import math

import numpy as np

from fullpose._typing import Array
from fullpose.plan import PlanOptions, plan
from fullpose.rig import Rig
from fullpose.verify import payload_attitudes, verify

EXACT = math.radians(1e-9)  # [rad]


def assert_flown_exactly(time: Array, path: Array, rig: Rig) -> Array:
    """A flight made from a path (n, 4) [rad] inside every limit is planned exactly and inside them; returns the plan's
    angles."""
    assert not verify(time, path, rig).violations
    attitude = payload_attitudes(rig, path)
    made = plan(time, attitude, rig, options=PlanOptions(best_effort=False))
    assert made.verdict.feasible
    angles = np.array(made.solution.angles)
    found = verify(time, angles, rig, attitude)
    assert not found.violations
    assert found.max_error < EXACT
    return angles
