"""`lagrange`: the equality-constrained step by Lagrange multipliers, open loop, without limits.

mathematics, section 7.

Source: Xu 2016, the baseline of Zhao 2025. Minimise 1/2 (x - d)^T W (x - d) subject to J (x - d) = w dt; setting the
derivatives of the Lagrangian to zero gives x = d + W^-1 J^T (J W^-1 J^T)^-1 w dt.

w dt is the rotation vector from the last target attitude to this one, the mean body rate over the interval: the rate
that attitude samples determine. Next to the rig's singularity, where J W^-1 J^T has no inverse, the inverse is damped
(`fullpose.step.squared_damping`), so that the step stays finite.
"""

from dataclasses import dataclass

import numpy as np

from fullpose._jit import kernel
from fullpose._typing import Array, Counts, Integers
from fullpose.kinematics import jacobian, null_vector, rotation_error
from fullpose.methods.base import StepMethod, Stepper
from fullpose.methods.unlimited import (
    TARGET,
    SequenceStepper,
    exact_start,
    first_sample,
    keep_sample,
    require_fourth_axis,
)
from fullpose.options import Options
from fullpose.rig import Rig
from fullpose.step import least_norm, squared_damping


@dataclass(frozen=True)
class LagrangeOptions(Options):
    """The method has none: W is the rig's."""


@kernel
def lagrange_block(
    _horizontal: bool,
    axes: Integers,
    weight: Array,
    _parameters: Array,
    time: Array,
    attitude: Array,
    state: Array,
    angles: Array,
    iterations: Counts,
) -> None:
    """See `sequence.SequenceKernel`; no parameters."""
    J = np.empty((3, 4))
    n = np.empty(4)
    e = np.empty(3)
    p = np.empty(4)
    zero = np.zeros(4)
    for k in range(time.shape[0]):
        C = attitude[k]
        if first_sample(time[k], C, state, angles[k]):
            continue
        rotation_error(C, state[TARGET : TARGET + 9].reshape(3, 3), e)
        jacobian(axes, state[0:4], J)
        damping = squared_damping(null_vector(J, n))
        least_norm(J, weight, zero, e, damping, p)
        for i in range(4):
            angles[k, i] = state[i] + p[i]
        iterations[k] = 1
        keep_sample(time[k], C, angles[k], state)


def _stepper(rig: Rig, options: LagrangeOptions, start: Array | None, attitude: Array) -> Stepper:  # noqa: ARG001
    require_fourth_axis("lagrange", rig)
    return SequenceStepper(rig, lagrange_block, [], exact_start(rig, attitude, start))


METHOD = StepMethod(
    name="lagrange",
    source="Xu 2016, the equality-constrained step, open loop; baseline of Zhao 2025",
    claims_limits=False,
    options=LagrangeOptions,
    stepper=_stepper,
)
