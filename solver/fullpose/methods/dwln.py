"""`dwln`: damped weighted least norm, iterated, then the exact re-solve with the base held (mathematics, section 6).

Source: Lin et al. 2022, Navigation and Control 21(2):56-66. Each sample iterates
dx = W^-1 J^T (J W^-1 J^T + s^2 I)^-1 e until |e| < 1e-3 deg, then solves the other three frames in the base chart,
on the branch cos d3 > 0. It iterates once at least: a slow flight turns by less than the tolerance a sample, and the
re-solve would make up for a base that is never asked to move. Damping after Chiaverini 1997: s^2 = 0 if
sigma_min >= sigma_0, else s_max^2 (1 - (sigma_min / sigma_0)^2). Weights, with
H = (d3max - d3min)^2 / (4 (d3max - d3) (d3 - d3min)) of Chan and Dubey 1995 over (-90, 90) deg:

    w1 = K / (1 + |dH/dd3|)                                      the base is light near the middle frame's pole
    w2 = 1 + A exp(-(sin d2 / B1)^2) exp(-(cos d3 / B2)^2)       the outer frame is heavy next to the rig's singularity
    w3 = 1 + |dH/dd3| while d3 moves toward its limit, else 1    keeps d3 inside
    w4 = 1

each times the rig's own weight. Whatever the options, s^2 is at least `LEAST_DAMPING` of the trace of J W^-1 J^T, so
that there is an inverse, and no iterate turns a frame by more than `LONGEST`. Both are ours, as are A, B1, B2, K,
sigma_0 and s_max: the paper's are not at hand. Its claim on d3 is a repulsion, not a bound, and the rig's own limits
are not looked at: the method claims none.
"""

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from fullpose._jit import inner
from fullpose._typing import Array
from fullpose.bounds import EXACT
from fullpose.charts import base_chart, nearest
from fullpose.kinematics import jacobian, payload_attitude, rotation_error
from fullpose.least_squares import gram, solve_symmetric
from fullpose.limits import WEIGHT
from fullpose.methods.base import StepMethod, Stepper
from fullpose.methods.block import BlockStepper, block_kernel, record_of
from fullpose.methods.state import Flight
from fullpose.methods.unlimited import open_flight
from fullpose.options import Options, ranged
from fullpose.rig import Rig

HALF_TURN = 0.5 * math.pi
NEAREST = 1e-3  # [rad] the distance to the limit is no smaller in H: on the limit and beyond it
LEAST_DAMPING = 1e-12  # of the trace: well above rounding, so that L D L^T finds a positive definite matrix
LONGEST = 0.2  # [rad] a frame in one iterate; the linearisation says nothing about longer ones


@dataclass(frozen=True)
class DwlnOptions(Options):
    """Constants of the weights and the damping, tolerance [rad] and cap of the iteration, and the exact re-solve."""

    base_weight: float = ranged(1.0, 1e-6, 1e6)  # K
    outer_gain: float = ranged(2.0, 0.0, 1e6)  # A
    outer_width: float = ranged(0.2, 1e-3, 1e3)  # B1, in sin d2
    middle_width: float = ranged(0.2, 1e-3, 1e3)  # B2, in cos d3
    damping_below: float = ranged(0.05, 0.0, 1.0)  # sigma_0
    max_damping: float = ranged(0.01, 0.0, 1.0)  # s_max
    tolerance: float = ranged(math.radians(1e-3), 1e-15, 1.0)
    max_iterations: int = ranged(20, 1, 1000)
    exact: bool = True


@inner
def smallest_singular_value(J: Array) -> float:
    """sigma_min of J (3, 4), from the eigenvalues of J J^T by the trigonometric formula (Smith 1961).

    Right to about 1e-8, the root of rounding, next to zero: the damping asks for no more.
    """
    a00, a01, a02, a11, a12, a22 = gram(J)
    mean = (a00 + a11 + a22) / 3.0
    b00 = a00 - mean
    b11 = a11 - mean
    b22 = a22 - mean
    off = a01 * a01 + a02 * a02 + a12 * a12
    spread = math.sqrt((b00 * b00 + b11 * b11 + b22 * b22 + 2.0 * off) / 6.0)
    if spread == 0.0:
        return math.sqrt(mean)
    determinant = b00 * (b11 * b22 - a12 * a12) - a01 * (a01 * b22 - a12 * a02) + a02 * (a01 * a12 - b11 * a02)
    cosine = min(1.0, max(-1.0, 0.5 * determinant / (spread * spread * spread)))
    lowest = mean + 2.0 * spread * math.cos(math.acos(cosine) / 3.0 + 2.0 * math.pi / 3.0)
    return math.sqrt(max(0.0, lowest))


@inner
def limit_gradient(d3: float) -> float:
    """|dH/dd3| for the range (-90, 90) deg; d3 is taken within half a turn of zero."""
    d3 = nearest(d3, 0.0)
    low = max(d3 + HALF_TURN, NEAREST)
    high = max(HALF_TURN - d3, NEAREST)
    # H = range^2 / (4 high low), range = pi
    return abs(math.pi * math.pi * 2.0 * d3 / (4.0 * high * high * low * low))


@inner
def dwln_weights(flight: Flight, own: DwlnOptions, moving: float) -> None:
    """weight <- the weights at the pose `next`; `moving`: the last change of d3, or one of its sign."""
    x = flight.next
    rig = flight.limits[WEIGHT]
    gradient = limit_gradient(x[2])
    s2 = math.sin(x[1]) / own.outer_width
    c3 = math.cos(x[2]) / own.middle_width
    flight.weight[0] = rig[0] * own.base_weight / (1.0 + gradient)
    flight.weight[1] = rig[1] * (1.0 + own.outer_gain * math.exp(-s2 * s2 - c3 * c3))
    flight.weight[2] = rig[2] * (1.0 + gradient if moving * nearest(x[2], 0.0) > 0.0 else 1.0)


@inner
def damped_step(flight: Flight, damping: float) -> None:
    """step <- W^-1 J^T (J W^-1 J^T + s^2 I)^-1 e, s^2 at least `LEAST_DAMPING` of the trace, shortened to `LONGEST`.

    damping: s^2.
    """
    J = flight.J
    p = flight.step
    A = flight.system
    y = A[:, 4]
    for i in range(4):
        p[i] = 1.0 / flight.weight[i]
    for r in range(3):
        y[r] = flight.e[r]
        for c in range(r + 1):
            total = 0.0
            for i in range(4):
                total += J[r, i] * J[c, i] * p[i]
            A[r, c] = total
    damping = max(damping, LEAST_DAMPING * (A[0, 0] + A[1, 1] + A[2, 2]))
    for r in range(3):
        A[r, r] += damping
    solve_symmetric(A, y, 3)
    longest = LONGEST
    for i in range(4):
        p[i] *= J[0, i] * y[0] + J[1, i] * y[1] + J[2, i] * y[2]
        longest = max(longest, abs(p[i]))
    if longest > LONGEST:
        for i in range(4):
            p[i] *= LONGEST / longest


@inner
def dwln_step(flight: Flight, parameters: Any, C: Array) -> tuple[int, int]:
    """See `block.propose`; parameters: (1,) the options."""
    own: DwlnOptions = parameters[0]
    x = flight.next
    for i in range(4):
        x[i] = flight.pose[i]
    moving = flight.rate[2]
    count = 0
    for again in range(own.max_iterations):
        payload_attitude(flight.axes, x, flight.F)
        if rotation_error(C, flight.F, flight.e) < own.tolerance and again > 0:
            break
        jacobian(flight.axes, x, flight.J)
        sigma = smallest_singular_value(flight.J)
        damping = 0.0
        if sigma < own.damping_below:
            damping = own.max_damping * own.max_damping * (1.0 - (sigma / own.damping_below) ** 2)
        dwln_weights(flight, own, moving)
        damped_step(flight, damping)
        for i in range(4):
            x[i] += flight.step[i]
        moving = flight.step[2]
        count += 1
    if own.exact:
        base_chart(flight.horizontal, C, x[0], 1.0, flight.guess)
        for i in range(1, 4):
            x[i] = nearest(flight.guess[i], x[i])
    return count, EXACT


dwln_block = block_kernel("dwln_block", dwln_step)


def _stepper(rig: Rig, options: DwlnOptions, start: Array | None, attitude: Array) -> Stepper:
    flight = open_flight("dwln", rig, start, attitude)
    pose = flight.pose
    if math.cos(pose[2]) < 0.0:
        # The method lives on the branch cos d3 > 0: the same base angle, the other solution of the frames inside.
        other = np.empty(4)
        base_chart(rig.geometry.horizontal, np.ascontiguousarray(attitude), pose[0], 1.0, other)
        pose[:] = [nearest(other[i], pose[i]) for i in range(4)]
    return BlockStepper(dwln_block, record_of(options), flight)


METHOD = StepMethod(
    name="dwln",
    source="Lin et al. 2022, damped weighted least norm with exact re-solve; Chiaverini 1997; Chan and Dubey 1995",
    claims_limits=False,
    options=DwlnOptions,
    stepper=_stepper,
)
