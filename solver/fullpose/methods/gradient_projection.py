"""`gradient_projection`: the least-norm step plus a step in the null space up a gradient (mathematics, section 7).

Source: Wang 2010; Dubey, Euler and Babcock 1991; the projection is Liegeois 1977.
dx = J^+ e + (I - J^+ J) k dt grad H, closed loop. H falls toward the position limits and the singularity:

    H = -sum_i 1 / (1 - u_i^2) * limits + (sin^2 d2 + cos^2 d3) * singularity,

u_i in (-1, 1) the place of frame i in its range (Dubey's function up to scale; a continuous frame has no term). The
gradient step is held to `max_rate`, since grad H grows without bound at a limit while the sample period does not
shrink. H repels from a limit; it does not keep the frame inside it, so the method claims no limits.
"""

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from fullpose._jit import inner
from fullpose._typing import Array
from fullpose.bounds import EXACT
from fullpose.limits import MAX, MIN
from fullpose.methods.base import StepMethod, Stepper
from fullpose.methods.block import BlockStepper, block_kernel, record_of
from fullpose.methods.state import Flight
from fullpose.methods.unlimited import increment_to, least_norm_step, open_flight
from fullpose.options import Options, ranged
from fullpose.rig import Rig

NEAREST = 1e-6  # 1 - u^2 is no smaller in the gradient, on the limit and beyond it


@dataclass(frozen=True)
class GradientProjectionOptions(Options):
    """Gains of the two parts of H [rad/s for a unit gradient], and the largest self-motion asked for [rad/s]."""

    limits: float = ranged(0.05, 0.0, 1e3)
    singularity: float = ranged(0.5, 0.0, 1e3)
    max_rate: float = ranged(1.0, 0.0, 1e3)


@inner
def ascent(flight: Flight, own: GradientProjectionOptions) -> None:
    """increment <- k grad H at the pose, no longer than max_rate, times the interval ahead [rad]."""
    d = flight.pose
    g = flight.increment
    for i in range(4):
        g[i] = 0.0
        low = flight.limits[MIN, i]
        high = flight.limits[MAX, i]
        if high < np.inf and high > low:
            half = 0.5 * (high - low)
            u = (d[i] - 0.5 * (high + low)) / half
            room = max(1.0 - u * u, NEAREST)
            g[i] = -own.limits * 2.0 * u / (room * room * half)
    g[1] += own.singularity * math.sin(2.0 * d[1])
    g[2] -= own.singularity * math.sin(2.0 * d[2])
    length = math.sqrt(g[0] * g[0] + g[1] * g[1] + g[2] * g[2] + g[3] * g[3])
    if length > own.max_rate:
        for i in range(4):
            g[i] *= own.max_rate / length
    for i in range(4):
        g[i] *= flight.ahead


@inner
def gradient_projection_step(flight: Flight, parameters: Any, C: Array) -> tuple[int, int]:
    """See `block.propose`; parameters: (1,) the options.

    J^+ e + (I - J^+ J) g = g + J^+ (e - J g): the step of least norm from g.
    """
    increment_to(flight, C)
    ascent(flight, parameters[0])
    least_norm_step(flight)
    return 1, EXACT


gradient_projection_block = block_kernel("gradient_projection_block", gradient_projection_step)


def unweighted_flight(name: str, rig: Rig, start: Array | None, attitude: Array) -> Flight:
    """`unlimited.open_flight` for the plain pseudo-inverse: all weights one."""
    flight = open_flight(name, rig, start, attitude)
    flight.weight[:] = 1.0
    return flight


def _stepper(rig: Rig, options: GradientProjectionOptions, start: Array | None, attitude: Array) -> Stepper:
    flight = unweighted_flight("gradient_projection", rig, start, attitude)
    return BlockStepper(gradient_projection_block, record_of(options), flight)


METHOD = StepMethod(
    name="gradient_projection",
    source="Wang 2010; Dubey, Euler and Babcock 1991; Liegeois 1977",
    claims_limits=False,
    options=GradientProjectionOptions,
    stepper=_stepper,
)
