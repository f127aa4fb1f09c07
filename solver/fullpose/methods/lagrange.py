"""`lagrange`: the equality-constrained step by Lagrange multipliers, open loop, without limits.

mathematics, section 7.

Source: Xu 2016, the baseline of Zhao 2025. Minimise 1/2 (x - d)^T W (x - d) subject to J (x - d) = w dt; setting the
derivatives of the Lagrangian to zero gives x = d + W^-1 J^T (J W^-1 J^T)^-1 w dt.

w dt is the rotation vector from the last target attitude to this one, the mean body rate over the interval: the rate
that attitude samples determine.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np

from fullpose._jit import inner
from fullpose._typing import Array
from fullpose.bounds import EXACT
from fullpose.kinematics import rotation_error
from fullpose.methods.base import StepMethod, Stepper
from fullpose.methods.block import BlockStepper, block_kernel
from fullpose.methods.state import Flight
from fullpose.methods.unlimited import least_norm_step, open_flight
from fullpose.options import Options
from fullpose.rig import Rig


@dataclass(frozen=True)
class LagrangeOptions(Options):
    """The method has none: W is the rig's."""


@inner
def lagrange_step(flight: Flight, _parameters: Any, C: Array) -> tuple[int, int]:
    """See `block.propose`."""
    rotation_error(C, flight.target, flight.e)
    least_norm_step(flight)
    return 1, EXACT


lagrange_block = block_kernel("lagrange_block", lagrange_step)


def _stepper(rig: Rig, options: LagrangeOptions, start: Array | None, attitude: Array) -> Stepper:  # noqa: ARG001
    return BlockStepper(lagrange_block, np.empty(0), open_flight("lagrange", rig, start, attitude))


METHOD = StepMethod(
    name="lagrange",
    source="Xu 2016, the equality-constrained step, open loop; baseline of Zhao 2025",
    claims_limits=False,
    options=LagrangeOptions,
    stepper=_stepper,
)
