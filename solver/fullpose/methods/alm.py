"""`alm`: the augmented Lagrange multiplier method with position limits (Zhao et al. 2025; mathematics, section 5).

M(x) = f(x) + (1/2r) sum_j { max[0, mu_j + r g_j(x)]^2 - mu_j^2 } + lambda^T h + (r/2) |h|^2, with
f = 1/2 (x-d-g)^T W (x-d-g), h = J (x-d) - e and the eight bounds of the box as g_j. The paper's f is divided by dt^2;
here everything is multiplied by it, which keeps r apart from the sample rate. The bounds are those of one sample
(`fullpose.limits`), so that rate and acceleration limits are obeyed as well as the paper's position limits; the unknown
is the step s = x - d rather than x, which costs no digits at large angles.

Where the iteration ends at its cap, its last step is the answer, cut off at the box, and its error shows. Only where no
step inside the box makes the increment, which the closed form tells (`step.quadratic_step`), has the paper's programme
no solution: there the step is `step.box_least_squares`, which makes the error as small as the limits allow, and the
sample is marked. Open loop never makes up for what such a sample left behind, so the mark stays until the attitude is
held again, for most flights to the end.
"""

import math
from dataclasses import dataclass
from enum import StrEnum
from typing import Protocol

import numpy as np

from fullpose._jit import inlined, inner
from fullpose._typing import Array
from fullpose.bounds import EXACT
from fullpose.charts import project_inner
from fullpose.errors import MethodError
from fullpose.kinematics import four_axis_pose, rotation_error
from fullpose.limits import WEIGHT, inside
from fullpose.methods.base import StepMethod, Stepper
from fullpose.methods.limited import (
    Gains,
    LimitedStepper,
    binding_code,
    block_kernel,
    finish,
    flight_from,
    goal_from,
    least_squares_step,
    null_space_increment,
    outermost_code,
    shift_box,
)
from fullpose.methods.state import Flight
from fullpose.options import Options, ranged
from fullpose.rig import Rig
from fullpose.step import quadratic_step, solve_symmetric


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

MOST_CHANGES = 5  # of the active bounds between two updates of the multipliers


class Multipliers(Protocol):
    """The iteration's constants and its unknowns, as `MULTIPLIERS` lays them out."""

    mode: int  # a `Mode` by its place
    penalty: float
    growth: float
    max_penalty: float
    residual: float
    max_iterations: int
    equality: Array  # (3,) lambda
    lower: Array  # (4,) mu of the lower bounds
    upper: Array
    products: Array  # (4, 5) J^T J and J^T e
    system: Array  # (4, 5) K and b


MULTIPLIERS = np.dtype(
    (
        np.record,
        np.dtype(
            [
                ("mode", "i8"), ("penalty", "f8"), ("growth", "f8"), ("max_penalty", "f8"), ("residual", "f8"),
                ("max_iterations", "i8"), ("equality", "f8", 3), ("lower", "f8", 4), ("upper", "f8", 4),
                ("products", "f8", (4, 5)), ("system", "f8", (4, 5)),
            ],
            align=True,
        ),
    )
)  # fmt: skip


@inlined
def active_bounds(own: Multipliers, r: float, lo: Array, hi: Array, s: Array) -> int:
    """Base 3, a digit a frame: no bound's term in M counts at s, the lower one's does (1), the upper one's (2)."""
    active = 0
    for i in range(3, -1, -1):
        active *= 3
        if own.upper[i] + r * (s[i] - hi[i]) > 0.0:
            active += 2
        elif own.lower[i] + r * (lo[i] - s[i]) > 0.0:
            active += 1
    return active


@inlined
def minimum_of_m(flight: Flight, own: Multipliers, r: float, active: int) -> bool:
    """step <- the minimum of M at penalty r with the bounds of `active`; false where it has none."""
    J = flight.J
    P = own.products
    K = own.system
    rest = active
    for i in range(4):
        weight = flight.limits[WEIGHT, i]
        K[i, 4] = weight * flight.increment[i] + r * P[i, 4]
        for k in range(3):
            K[i, 4] -= J[k, i] * own.equality[k]
        for j in range(i + 1):
            K[i, j] = r * P[i, j]
        K[i, i] += weight
        if rest % 3 == 1:
            K[i, i] += r
            K[i, 4] += r * flight.lo[i] + own.lower[i]
        elif rest % 3 == 2:
            K[i, i] += r
            K[i, 4] += r * flight.hi[i] - own.upper[i]
        rest //= 3
    if not solve_symmetric(K, K[:, 4], 4):
        return False
    for i in range(4):
        flight.step[i] = K[i, 4]
    return True


@inlined
def update_multipliers(flight: Flight, own: Multipliers, r: float) -> float:
    """Move lambda and mu up their gradients; returns the largest violation of the constraints and complementarity."""
    J = flight.J
    s = flight.step
    violation = 0.0
    for k in range(3):
        h = J[k, 0] * s[0] + J[k, 1] * s[1] + J[k, 2] * s[2] + J[k, 3] * s[3] - flight.e[k]
        own.equality[k] += r * h
        violation = max(violation, abs(h))
    for i in range(4):
        # Complementarity: a bound is kept, and its multiplier is zero unless it is met.
        above = s[i] - flight.hi[i]
        below = flight.lo[i] - s[i]
        violation = max(violation, abs(max(above, -own.upper[i] / r)), abs(max(below, -own.lower[i] / r)))
        own.upper[i] = max(0.0, own.upper[i] + r * above)
        own.lower[i] = max(0.0, own.lower[i] + r * below)
    return violation


@inner
def multiplier_step(flight: Flight, own: Multipliers) -> int:
    """step <- the one by the augmented multiplier method; returns the iterations, negative where it has not settled.

    Of the flight J, e, increment and weights are read, and lo, hi, which are bounds of the step here.
    """
    J = flight.J
    e = flight.e
    s = flight.step
    r = own.penalty
    for i in range(3):
        own.equality[i] = 0.0
    for i in range(4):
        own.lower[i] = 0.0
        own.upper[i] = 0.0
        s[i] = 0.0
        own.products[i, 4] = J[0, i] * e[0] + J[1, i] * e[1] + J[2, i] * e[2]
        for j in range(i + 1):
            own.products[i, j] = J[0, i] * J[0, j] + J[1, i] * J[1, j] + J[2, i] * J[2, j]
    active = active_bounds(own, r, flight.lo, flight.hi, s)
    changes = 0
    for iteration in range(1, own.max_iterations + 1):
        if not minimum_of_m(flight, own, r, active):
            return -iteration
        # Multipliers answer for a minimum of M only where the bounds reckoned with are those that count there.
        before = active
        active = active_bounds(own, r, flight.lo, flight.hi, s)
        if active != before and changes < MOST_CHANGES:
            changes += 1
            continue
        changes = 0
        if update_multipliers(flight, own, r) <= own.residual:
            return iteration
        r = min(r * own.growth, own.max_penalty)
        active = active_bounds(own, r, flight.lo, flight.hi, s)
    return -int(own.max_iterations)


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
    return quadratic_step(
        flight.J, flight.null, manipulability, flight.limits[WEIGHT], nowhere, flight.increment, flight.e,
        flight.lo, flight.hi, flight.tolerance, flight.next,
    ) and reaches(flight.J, flight.next, flight.e, residual)  # fmt: skip


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
    """See `limited.propose`; parameters: (1,) `MULTIPLIERS`."""
    own: Multipliers = parameters[0]
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
