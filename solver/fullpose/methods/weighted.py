"""`weighted`: weighted least squares with a base weight that adapts (mathematics, section 7).

Source: Carter 2010. Far from the singularity of the outer, middle and inner frames taken as a three-axis rig
(cos d3 = 0) the base is heavy and the rig moves as a three-axis one; near it the base weight falls and the base moves.

The law between the two weights is ours, the paper's constants are not at hand:
w1 = near + (far - near) (1 - exp(-(cos d3 / width)^2)). Closed loop: the step corrects the error of the last sample.
"""

import math
from dataclasses import dataclass

import numpy as np

from fullpose._jit import kernel
from fullpose._typing import Array, Counts, Integers
from fullpose.kinematics import jacobian, null_vector, payload_attitude, rotation_error
from fullpose.methods.base import StepMethod, Stepper
from fullpose.methods.unlimited import (
    SequenceStepper,
    exact_start,
    first_sample,
    keep_sample,
    require_fourth_axis,
)
from fullpose.options import Options, ranged
from fullpose.rig import Rig
from fullpose.step import least_norm, squared_damping


@dataclass(frozen=True)
class WeightedOptions(Options):
    """Base weights far from and at cos d3 = 0, times the rig's own, and the width of the change in cos d3."""

    far: float = ranged(100.0, 1e-6, 1e6)
    near: float = ranged(0.1, 1e-6, 1e6)
    width: float = ranged(0.35, 1e-3, 10.0)


@kernel
def weighted_block(
    _horizontal: bool,
    axes: Integers,
    weight: Array,
    parameters: Array,
    time: Array,
    attitude: Array,
    state: Array,
    angles: Array,
    iterations: Counts,
) -> None:
    """See `sequence.SequenceKernel`; parameters: far, near, width."""
    F = np.empty((3, 3))
    J = np.empty((3, 4))
    n = np.empty(4)
    e = np.empty(3)
    p = np.empty(4)
    w = weight.copy()
    zero = np.zeros(4)
    far, near, width = parameters[0], parameters[1], parameters[2]
    for k in range(time.shape[0]):
        C = attitude[k]
        if first_sample(time[k], C, state, angles[k]):
            continue
        d = state[0:4]
        payload_attitude(axes, d, F)
        rotation_error(C, F, e)
        jacobian(axes, d, J)
        c3 = math.cos(d[2]) / width
        w[0] = weight[0] * (near + (far - near) * (1.0 - math.exp(-c3 * c3)))
        least_norm(J, w, zero, e, squared_damping(null_vector(J, n)), p)
        for i in range(4):
            angles[k, i] = d[i] + p[i]
        iterations[k] = 1
        keep_sample(time[k], C, angles[k], state)


def _stepper(rig: Rig, options: WeightedOptions, start: Array | None, attitude: Array) -> Stepper:
    require_fourth_axis("weighted", rig)
    parameters = [options.far, options.near, options.width]
    return SequenceStepper(rig, weighted_block, parameters, exact_start(rig, attitude, start))


METHOD = StepMethod(
    name="weighted",
    source="Carter 2010, weighted least squares with an adaptive base weight",
    claims_limits=False,
    options=WeightedOptions,
    stepper=_stepper,
)
