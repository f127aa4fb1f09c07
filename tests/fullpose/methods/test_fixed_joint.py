"""Gradient projection, then exact with one frame held."""

import numpy as np
import pytest

from fullpose.attitude import dcm_from_quaternion
from fullpose.methods import fixed_joint, gradient_projection
from fullpose.rig import builtin_rigs
from fullpose.scenarios import random_flight
from fullpose.verify import verify


@pytest.mark.parametrize("name", ["vertical-4", "horizontal-4"])
def test_one_frame_is_the_gradient_projections(name: str) -> None:
    rig = builtin_rigs()[name]
    time, q = random_flight(4, 1.0, 1000.0, 1.5)
    C = dcm_from_quaternion(q)
    angles = fixed_joint.METHOD.stepper(rig, fixed_joint.FixedJointOptions(), None, C[0]).block(time, C).angles
    assert verify(time, angles, rig, C).max_matrix_error < 2e-15
    for k in range(1, 1000, 97):
        # The gradient projection of the same pose: base or inner is kept, the others move by the step's second order.
        stepper = gradient_projection.METHOD.stepper(
            rig, gradient_projection.GradientProjectionOptions(), angles[k - 1], C[k - 1]
        )
        step = stepper.block(time[k - 1 : k + 1], C[k - 1 : k + 1]).angles[1]
        gap = np.abs(angles[k] - step)
        assert min(gap[0], gap[3]) < 1e-12
        assert gap.max() < 1e-4
