"""`fixed_joint`: gradient projection, then one frame held and the other three solved exactly (mathematics, section 7).

Source: Zu 2005. The frame that is held is the base or the inner one, whichever chart is farther from its fold
(mathematics, section 3). The attitude is exact; the limits are those of `gradient_projection`, avoided but not kept.
"""

from typing import Any

from fullpose._jit import inner
from fullpose._typing import Array
from fullpose.bounds import EXACT
from fullpose.charts import project
from fullpose.methods.base import StepMethod, Stepper
from fullpose.methods.block import BlockStepper, block_kernel, record_of
from fullpose.methods.gradient_projection import (
    GradientProjectionOptions,
    gradient_projection_step,
    unweighted_flight,
)
from fullpose.methods.state import Flight
from fullpose.rig import Rig


class FixedJointOptions(GradientProjectionOptions):
    """Those of `gradient_projection`."""


@inner
def fixed_joint_step(flight: Flight, parameters: Any, C: Array) -> tuple[int, int]:
    """See `block.propose`; parameters: (1,) the options."""
    gradient_projection_step(flight, parameters, C)
    project(flight.horizontal, C, flight.next, flight.next)
    return 1, EXACT


fixed_joint_block = block_kernel("fixed_joint_block", fixed_joint_step)


def _stepper(rig: Rig, options: FixedJointOptions, start: Array | None, attitude: Array) -> Stepper:
    flight = unweighted_flight("fixed_joint", rig, start, attitude)
    return BlockStepper(fixed_joint_block, record_of(options), flight)


METHOD = StepMethod(
    name="fixed_joint",
    source="Zu 2005, after the gradient projection of Dubey 1991",
    claims_limits=False,
    options=FixedJointOptions,
    stepper=_stepper,
)
