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

import numpy as np

from fullpose._jit import kernel
from fullpose._typing import Array, Counts, Integers
from fullpose.charts import base_chart, nearest
from fullpose.kinematics import jacobian, payload_attitude, rotation_error
from fullpose.methods.base import StepMethod, Stepper
from fullpose.methods.unlimited import (
    LAST_STEP,
    SequenceStepper,
    exact_start,
    first_sample,
    keep_sample,
    require_fourth_axis,
)
from fullpose.options import Options, ranged
from fullpose.rig import Rig
from fullpose.step import solve_symmetric

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


@kernel
def smallest_singular_value(J: Array) -> float:
    """sigma_min of J (3, 4), from the eigenvalues of J J^T by the trigonometric formula (Smith 1961).

    Right to about 1e-8, the root of rounding, next to zero: the damping asks for no more.
    """
    a00 = 0.0
    a01 = 0.0
    a02 = 0.0
    a11 = 0.0
    a12 = 0.0
    a22 = 0.0
    for i in range(4):
        a00 += J[0, i] * J[0, i]
        a01 += J[0, i] * J[1, i]
        a02 += J[0, i] * J[2, i]
        a11 += J[1, i] * J[1, i]
        a12 += J[1, i] * J[2, i]
        a22 += J[2, i] * J[2, i]
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


@kernel
def limit_gradient(d3: float) -> float:
    """|dH/dd3| for the range (-90, 90) deg; d3 is taken within half a turn of zero."""
    d3 = nearest(d3, 0.0)
    low = max(d3 + HALF_TURN, NEAREST)
    high = max(HALF_TURN - d3, NEAREST)
    # H = range^2 / (4 high low), range = pi
    return abs(math.pi * math.pi * 2.0 * d3 / (4.0 * high * high * low * low))


@kernel
def dwln_weights(rig_weight: Array, parameters: Array, x: Array, moving: float, w: Array) -> None:
    """w <- the weights at x; `moving` is the last change of d3. x, w, rig_weight (4,); parameters: K, A, B1, B2, ..."""
    gradient = limit_gradient(x[2])
    s2 = math.sin(x[1]) / parameters[2]
    c3 = math.cos(x[2]) / parameters[3]
    w[0] = rig_weight[0] * parameters[0] / (1.0 + gradient)
    w[1] = rig_weight[1] * (1.0 + parameters[1] * math.exp(-s2 * s2 - c3 * c3))
    w[2] = rig_weight[2] * (1.0 + gradient if moving * nearest(x[2], 0.0) > 0.0 else 1.0)
    w[3] = rig_weight[3]


@kernel
def damped_step(J: Array, w: Array, e: Array, damping: float, A: Array, p: Array) -> None:
    """p <- W^-1 J^T (J W^-1 J^T + s^2 I)^-1 e, s^2 at least `LEAST_DAMPING` of the trace, shortened to `LONGEST`.

    J (3, 4); w, p (4,); e (3,); damping: s^2; A (3, 4) is room to work in.
    """
    y = A[:, 3]
    for i in range(4):
        p[i] = 1.0 / w[i]
    for r in range(3):
        y[r] = e[r]
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


@kernel
def dwln_block(
    horizontal: bool,
    axes: Integers,
    weight: Array,
    parameters: Array,
    time: Array,
    attitude: Array,
    state: Array,
    angles: Array,
    iterations: Counts,
) -> None:
    """See `sequence.SequenceKernel`; parameters: K, A, B1, B2, sigma_0, s_max, tolerance, cap, exact."""
    F = np.empty((3, 3))
    J = np.empty((3, 4))
    e = np.empty(3)
    p = np.empty(4)
    w = np.empty(4)
    A = np.empty((3, 4))
    sigma_0, s_max = parameters[4], parameters[5]
    for k in range(time.shape[0]):
        C = attitude[k]
        x = angles[k]
        if first_sample(time[k], C, state, x):
            continue
        for i in range(4):
            x[i] = state[i]
        moving = state[LAST_STEP + 2]
        for again in range(int(parameters[7])):
            payload_attitude(axes, x, F)
            if rotation_error(C, F, e) < parameters[6] and again > 0:
                break
            jacobian(axes, x, J)
            sigma = smallest_singular_value(J)
            damping = 0.0
            if sigma < sigma_0:
                damping = s_max * s_max * (1.0 - (sigma / sigma_0) ** 2)
            dwln_weights(weight, parameters, x, moving, w)
            damped_step(J, w, e, damping, A, p)
            for i in range(4):
                x[i] += p[i]
            moving = p[2]
            iterations[k] += 1
        if parameters[8] != 0.0:
            base_chart(horizontal, C, x[0], 1.0, p)
            for i in range(1, 4):
                x[i] = nearest(p[i], x[i])
        keep_sample(time[k], C, x, state)


def _stepper(rig: Rig, options: DwlnOptions, start: Array | None, attitude: Array) -> Stepper:
    require_fourth_axis("dwln", rig)
    pose = exact_start(rig, attitude, start)
    if math.cos(pose[2]) < 0.0:
        # The method lives on the branch cos d3 > 0: the same base angle, the other solution of the frames inside.
        other = np.empty(4)
        base_chart(rig.geometry.horizontal, np.ascontiguousarray(attitude), pose[0], 1.0, other)
        pose = np.array([nearest(other[i], pose[i]) for i in range(4)])
    parameters = [
        options.base_weight,
        options.outer_gain,
        options.outer_width,
        options.middle_width,
        options.damping_below,
        options.max_damping,
        options.tolerance,
        float(options.max_iterations),
        float(options.exact),
    ]
    return SequenceStepper(rig, dwln_block, parameters, pose)


METHOD = StepMethod(
    name="dwln",
    source="Lin et al. 2022, damped weighted least norm with exact re-solve; Chiaverini 1997; Chan and Dubey 1995",
    claims_limits=False,
    options=DwlnOptions,
    stepper=_stepper,
)
