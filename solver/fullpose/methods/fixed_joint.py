"""`fixed_joint`: gradient projection, then one frame held and the other three solved exactly (mathematics, section 7).

Source: Zu 2005. The frame that is held is the base or the inner one, whichever chart is farther from its fold
(mathematics, section 3). The attitude is exact; the limits are those of `gradient_projection`, avoided but not kept.
"""

import numpy as np

from fullpose._jit import kernel
from fullpose._typing import Array, Counts, Integers
from fullpose.charts import project
from fullpose.methods.base import StepMethod, Stepper
from fullpose.methods.gradient_projection import (
    GradientProjectionOptions,
    gradient_parameters,
    gradient_projection_step,
)
from fullpose.methods.unlimited import (
    CLOCK,
    SequenceStepper,
    exact_start,
    first_sample,
    keep_sample,
    require_fourth_axis,
)
from fullpose.rig import Rig


class FixedJointOptions(GradientProjectionOptions):
    """Those of `gradient_projection`."""


@kernel
def fixed_joint_block(
    horizontal: bool,
    axes: Integers,
    _weight: Array,
    parameters: Array,
    time: Array,
    attitude: Array,
    state: Array,
    angles: Array,
    iterations: Counts,
) -> None:
    """See `sequence.SequenceKernel`; parameters as in `gradient_projection_step`."""
    F = np.empty((3, 3))
    J = np.empty((3, 4))
    n = np.empty(4)
    for k in range(time.shape[0]):
        C = attitude[k]
        if first_sample(time[k], C, state, angles[k]):
            continue
        h = time[k] - state[CLOCK]
        gradient_projection_step(axes, parameters, state[0:4], C, h, F, J, n, angles[k])
        project(horizontal, C, angles[k], angles[k])
        iterations[k] = 1
        keep_sample(time[k], C, angles[k], state)


def _stepper(rig: Rig, options: FixedJointOptions, start: Array | None, attitude: Array) -> Stepper:
    require_fourth_axis("fixed_joint", rig)
    parameters = gradient_parameters(rig, options)
    return SequenceStepper(rig, fixed_joint_block, parameters, exact_start(rig, attitude, start))


METHOD = StepMethod(
    name="fixed_joint",
    source="Zu 2005, after the gradient projection of Dubey 1991",
    claims_limits=False,
    options=FixedJointOptions,
    stepper=_stepper,
)
