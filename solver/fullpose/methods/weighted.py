"""`weighted`: weighted least squares with a base weight that adapts (mathematics, section 7).

Source: Carter 2010. Far from the singularity of the outer, middle and inner frames taken as a three-axis rig
(cos d3 = 0) the base is heavy and the rig moves as a three-axis one; near it the base weight falls and the base moves.

The law between the two weights is ours, the paper's constants are not at hand:
w1 = near + (far - near) (1 - exp(-(cos d3 / width)^2)). Closed loop: the step corrects the error of the last sample.
"""

import math
from dataclasses import dataclass
from typing import Any

from fullpose._jit import inner
from fullpose._typing import Array
from fullpose.bounds import EXACT
from fullpose.limits import WEIGHT
from fullpose.methods.base import StepMethod, Stepper
from fullpose.methods.block import BlockStepper, block_kernel, record_of
from fullpose.methods.state import Flight
from fullpose.methods.unlimited import increment_to, least_norm_step, open_flight
from fullpose.options import Options, ranged
from fullpose.rig import Rig


@dataclass(frozen=True)
class WeightedOptions(Options):
    """Base weights far from and at cos d3 = 0, times the rig's own, and the width of the change in cos d3."""

    far: float = ranged(100.0, 1e-6, 1e6)
    near: float = ranged(0.1, 1e-6, 1e6)
    width: float = ranged(0.35, 1e-3, 10.0)


@inner
def weighted_step(flight: Flight, parameters: Any, C: Array) -> tuple[int, int]:
    """See `block.propose`; parameters: (1,) the options."""
    own: WeightedOptions = parameters[0]
    increment_to(flight, C)
    c3 = math.cos(flight.pose[2]) / own.width
    base = own.near + (own.far - own.near) * (1.0 - math.exp(-c3 * c3))
    flight.weight[0] = flight.limits[WEIGHT, 0] * base
    least_norm_step(flight)
    return 1, EXACT


weighted_block = block_kernel("weighted_block", weighted_step)


def _stepper(rig: Rig, options: WeightedOptions, start: Array | None, attitude: Array) -> Stepper:
    return BlockStepper(weighted_block, record_of(options), open_flight("weighted", rig, start, attitude))


METHOD = StepMethod(
    name="weighted",
    source="Carter 2010, weighted least squares with an adaptive base weight",
    claims_limits=False,
    options=WeightedOptions,
    stepper=_stepper,
)
