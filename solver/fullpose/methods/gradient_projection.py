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

import numpy as np

from fullpose._jit import kernel
from fullpose._typing import Array, Counts, Integers
from fullpose.kinematics import jacobian, null_vector, payload_attitude, rotation_error
from fullpose.methods.base import StepMethod, Stepper
from fullpose.methods.unlimited import (
    CLOCK,
    SequenceStepper,
    exact_start,
    first_sample,
    keep_sample,
    require_fourth_axis,
)
from fullpose.options import Options, ranged
from fullpose.rig import Rig
from fullpose.step import least_norm, squared_damping

NEAREST = 1e-6  # 1 - u^2 is no smaller in the gradient, on the limit and beyond it


@dataclass(frozen=True)
class GradientProjectionOptions(Options):
    """Gains of the two parts of H [rad/s for a unit gradient], and the largest self-motion asked for [rad/s]."""

    limits: float = ranged(0.05, 0.0, 1e3)
    singularity: float = ranged(0.5, 0.0, 1e3)
    max_rate: float = ranged(1.0, 0.0, 1e3)


@kernel
def ascent(low: Array, high: Array, d: Array, limits: float, singularity: float, max_rate: float, g: Array) -> None:
    """g <- k grad H at d [rad/s], no longer than max_rate. low, high, d, g (4,)."""
    for i in range(4):
        g[i] = 0.0
        if high[i] < np.inf and high[i] > low[i]:
            half = 0.5 * (high[i] - low[i])
            u = (d[i] - 0.5 * (high[i] + low[i])) / half
            room = max(1.0 - u * u, NEAREST)
            g[i] = -limits * 2.0 * u / (room * room * half)
    g[1] += singularity * math.sin(2.0 * d[1])
    g[2] -= singularity * math.sin(2.0 * d[2])
    length = math.sqrt(g[0] * g[0] + g[1] * g[1] + g[2] * g[2] + g[3] * g[3])
    if length > max_rate:
        for i in range(4):
            g[i] *= max_rate / length


@kernel
def gradient_projection_step(
    axes: Integers, parameters: Array, d: Array, C: Array, h: float, F: Array, J: Array, n: Array, x: Array
) -> None:
    """x <- d + J^+ e + (I - J^+ J) g h for the target C. parameters: limits, singularity, max_rate, low (4), high (4).

    d, n, x (4,); C, F (3, 3); J (3, 4); h [s].
    """
    e = np.empty(3)
    g = np.empty(4)
    unit = np.ones(4)
    payload_attitude(axes, d, F)
    rotation_error(C, F, e)
    jacobian(axes, d, J)
    ascent(parameters[3:7], parameters[7:11], d, parameters[0], parameters[1], parameters[2], g)
    for i in range(4):
        g[i] *= h
    # J^+ e + (I - J^+ J) g = g + J^+ (e - J g)
    least_norm(J, unit, g, e, squared_damping(null_vector(J, n)), x)
    for i in range(4):
        x[i] += d[i]


@kernel
def gradient_projection_block(
    _horizontal: bool,
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
        iterations[k] = 1
        keep_sample(time[k], C, angles[k], state)


def gradient_parameters(rig: Rig, options: GradientProjectionOptions) -> list[float]:
    """What `gradient_projection_step` reads."""
    gains = [options.limits, options.singularity, options.max_rate]
    return [*gains, *rig.position_min.tolist(), *rig.position_max.tolist()]


def _stepper(rig: Rig, options: GradientProjectionOptions, start: Array | None, attitude: Array) -> Stepper:
    require_fourth_axis("gradient_projection", rig)
    parameters = gradient_parameters(rig, options)
    return SequenceStepper(rig, gradient_projection_block, parameters, exact_start(rig, attitude, start))


METHOD = StepMethod(
    name="gradient_projection",
    source="Wang 2010; Dubey, Euler and Babcock 1991; Liegeois 1977",
    claims_limits=False,
    options=GradientProjectionOptions,
    stepper=_stepper,
)
