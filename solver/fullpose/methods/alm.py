"""`alm`: the augmented Lagrange multiplier method with position limits (Zhao et al. 2025; mathematics, section 5).

M(x) = f(x) + (1/2r) sum_j { max[0, mu_j + r g_j(x)]^2 - mu_j^2 } + lambda^T h + (r/2) |h|^2, with
f = 1/2 (x-d-g)^T W (x-d-g), h = J (x-d) - e and the eight bounds of the box as g_j. The paper's f is divided by dt^2;
here everything is multiplied by it, which keeps r apart from the sample rate. The bounds are those of one sample
(`fullpose.limits`), so that rate and acceleration limits are obeyed as well as the paper's position limits; the unknown
is the step s = x - d rather than x, which costs no digits at large angles.

Where the iteration (`multipliers`) ends at its cap, its last step is the answer, cut off at the box, and its error
shows. Only where no step inside the box makes the increment, which the closed form tells (`step.quadratic_step`), has
the paper's programme no solution: there the step is `least_squares.box_least_squares`, which makes the error as small
as the limits allow, and the sample is marked. Open loop never makes up for what such a sample left behind, so the mark
stays until the attitude is held again, for most flights to the end.
"""

import math
from dataclasses import dataclass
from enum import StrEnum

import numpy as np

from fullpose._jit import inner
from fullpose._typing import Array
from fullpose.bounds import EXACT
from fullpose.charts import project_inner
from fullpose.errors import MethodError
from fullpose.kinematics import four_axis_pose, rotation_error
from fullpose.limits import inside
from fullpose.methods.base import StepMethod, Stepper
from fullpose.methods.block import block_kernel
from fullpose.methods.limited import (
    Gains,
    LimitedStepper,
    binding_code,
    closed_form_step,
    finish,
    flight_from,
    goal_from,
    least_squares_step,
    null_space_increment,
    outermost_code,
    shift_box,
)
from fullpose.methods.multipliers import MULTIPLIERS, Multipliers, multiplier_step
from fullpose.methods.state import Flight, box_ahead
from fullpose.options import Options, ranged
from fullpose.rig import Rig


class Mode(StrEnum):
    """What the step is asked for.

    closed_loop: the increment from the present attitude to the next, which does not drift; what its linearisation
    leaves is the method's error. open_loop: the flight's own increment, as in the paper, whose linearisation error adds
    up. exact: the closed loop, and then the whole exact solution curve. exact_inner: the closed loop, and then the
    inner frame held and the other three solved exactly, the second optimisation that the paper proposes.
    """

    CLOSED_LOOP = "closed_loop"
    OPEN_LOOP = "open_loop"
    EXACT = "exact"
    EXACT_INNER = "exact_inner"


# As the kernel reads them.
CLOSED_LOOP, OPEN_LOOP, EXACT_CURVE, EXACT_INNER = range(len(Mode))


@dataclass(frozen=True)
class AlmOptions(Options):
    """Raises `MethodError` where a value is out of range.

    mode: see `Mode`. penalty: r of the first iteration; growth: beta, its factor from one to the next; max_penalty:
    where it stops growing; residual: |h| [rad] and complementarity at which the iteration stops; max_iterations: its
    cap. avoidance, centring [rad/s], homing [1/s], recovery: as in `ExactOptions`; with zero gains f is the paper's.
    """

    mode: Mode = Mode.CLOSED_LOOP
    penalty: float = ranged(10.0, 1e-3, 1e8)
    growth: float = ranged(3.0, 1.0, 1e3)
    max_penalty: float = ranged(1e8, 1e-3, 1e10)
    residual: float = ranged(1e-13, 1e-15, 1.0)
    max_iterations: int = ranged(30, 1, 1000)
    avoidance: float = ranged(2.0, 0.0, 1e6)
    centring: float = ranged(2.0, 0.0, 1e6)
    homing: float = ranged(0.0, 0.0, 1e6)
    recovery: float = ranged(0.5, 1e-6, 1.0)

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.max_penalty < self.penalty:
            raise MethodError(f"option max_penalty = {self.max_penalty!r}: expected at least penalty, {self.penalty:g}")


HELD = math.radians(1e-9)  # in open loop, a sample within this of the attitude has nothing to make up for


@inner
def reaches(J: Array, s: Array, e: Array, residual: float) -> bool:
    """Whether the step s (4,) makes the increment e (3,) [rad], to a thousandth of it or the residual."""
    for k in range(3):
        gap = J[k, 0] * s[0] + J[k, 1] * s[1] + J[k, 2] * s[2] + J[k, 3] * s[3] - e[k]
        if abs(gap) > max(residual, 1e-3 * abs(e[k])):
            return False
    return True


@inner
def possible(flight: Flight, manipulability: float, residual: float) -> bool:
    """Whether a step inside the box lo, hi (of the step) makes the increment e, by the closed form; next is filled.

    residual as in `reaches`.
    """
    nowhere = flight.damping
    for i in range(4):
        nowhere[i] = 0.0
    return closed_form_step(flight, manipulability, nowhere, flight.next) and reaches(
        flight.J, flight.next, flight.e, residual
    )


@inner
def hold_inner(flight: Flight) -> None:
    """next <- the exact pose for the goal with the inner angle of next, where that lies inside the box."""
    y = flight.guess
    project_inner(flight.horizontal, flight.goal, flight.next, y)
    if inside(y, flight.lo, flight.hi, flight.tolerance):
        for i in range(4):
            flight.next[i] = y[i]


@inner
def least_error_step(flight: Flight, own: Multipliers, manipulability: float) -> int:
    """step <- where no step inside the box makes the increment, the one that makes the error least; its code.

    `EXACT`, and the iteration's step stays, where there is one.
    """
    if possible(flight, manipulability, own.residual):
        return EXACT
    code = binding_code(flight, least_squares_step(flight, manipulability))
    if code == EXACT and not reaches(flight.J, flight.step, flight.e, own.residual):
        code = outermost_code(flight, flight.step)
    return code


@inner
def alm_step(flight: Flight, parameters: Array, C: Array) -> tuple[int, int]:
    """See `block.propose`; parameters: (1,) `MULTIPLIERS`."""
    own: Multipliers = parameters[0]
    box_ahead(flight)
    null_space_increment(flight)
    manipulability = four_axis_pose(flight.horizontal, flight.pose, flight.F, flight.J, flight.null)
    if own.mode != OPEN_LOOP:
        goal_from(flight, C)
    else:
        flight.on_target = flight.code == EXACT or rotation_error(flight.F, flight.target, flight.e) <= HELD
        rotation_error(C, flight.target, flight.e)
    shift_box(flight, flight.pose, -1.0)
    count = multiplier_step(flight, own)
    code = EXACT
    # Not settled: at the cap, or because no step inside the box has this increment.
    if count < 0 and own.mode != EXACT_CURVE:
        code = least_error_step(flight, own, manipulability)
    shift_box(flight, flight.pose, 1.0)
    for i in range(4):
        flight.guess[i] = flight.pose[i] + flight.step[i]
        # Within the residual the settled step may be outside its box; the limits hold to the last digit.
        flight.next[i] = min(max(flight.guess[i], flight.lo[i]), flight.hi[i])
    if own.mode == EXACT_CURVE:
        _, code = finish(flight)
    elif code == EXACT:
        if own.mode == EXACT_INNER:
            hold_inner(flight)
        if not flight.on_target:
            code = int(flight.code)
    return abs(count), code


alm_block = block_kernel("alm_block", alm_step)


def multipliers(options: AlmOptions) -> Multipliers:
    """The record of an iteration with these options."""
    own: Multipliers = np.zeros(1, MULTIPLIERS)[0]
    own.mode = list(Mode).index(options.mode)
    own.penalty, own.growth, own.max_penalty = options.penalty, options.growth, options.max_penalty
    own.residual, own.max_iterations = options.residual, options.max_iterations
    return own


def _stepper(rig: Rig, options: AlmOptions, start: Array | None, attitude: Array) -> Stepper:
    gains = Gains(options.avoidance, options.centring, options.homing, options.recovery)
    parameters = np.array([multipliers(options)], MULTIPLIERS)
    return LimitedStepper(alm_block, parameters, gains, flight_from("alm", rig, start, attitude))


METHOD = StepMethod(
    name="alm",
    source="Zhao et al. 2025, doi 10.19306/j.cnki.2095-8110.2025.03.014",
    claims_limits=True,
    options=AlmOptions,
    stepper=_stepper,
)
