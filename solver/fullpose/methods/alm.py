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

import numpy as np

from fullpose._jit import inlined, inner, kernel
from fullpose._typing import Array, Codes, Counts, Integers
from fullpose.charts import project_inner
from fullpose.errors import MethodError
from fullpose.kinematics import four_axis_pose, rotation_error
from fullpose.limits import WEIGHT, inside, limit_table
from fullpose.methods.base import Block, StepMethod
from fullpose.methods.start_pose import start_pose
from fullpose.methods.state import (
    CLOCK,
    CODE,
    DAMPING,
    FRESH,
    GUESS,
    HI,
    INCREMENT,
    LO,
    NULL,
    PHASE,
    POSE,
    ROWS,
    SHIFT,
    STEP,
    TOLERANCE,
    advance,
    binding_code,
    finish,
    goal_from,
    hold_position,
    new_state,
    null_space_increment,
    outermost_code,
    prepare,
)
from fullpose.options import Options, ranged
from fullpose.rig import Rig
from fullpose.solution import EXACT
from fullpose.step import box_least_squares, quadratic_step, solve_symmetric, squared_damping


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

# Rows of the multipliers' work array (MULTIPLIER_ROWS, 5): lambda, mu of both sides, then 4 x 4 with a column on the
# right: J^T J and J^T e, K and b
EQUALITY, LOWER, UPPER, PRODUCTS, SYSTEM = 0, 1, 2, 3, 7
MULTIPLIER_ROWS = 11
MOST_CHANGES = 5  # of the active bounds between two updates of the multipliers


@inlined
def active_bounds(room: Array, r: float, lo: Array, hi: Array, s: Array) -> int:
    """Base 3, a digit a frame: no bound's term in M counts at s, the lower one's does (1), the upper one's (2)."""
    active = 0
    for i in range(3, -1, -1):
        active *= 3
        if room[UPPER, i] + r * (s[i] - hi[i]) > 0.0:
            active += 2
        elif room[LOWER, i] + r * (lo[i] - s[i]) > 0.0:
            active += 1
    return active


@inner
def multiplier_step(
    J: Array, weight: Array, g: Array, e: Array, lo: Array, hi: Array, tuning: Array, room: Array, s: Array
) -> int:
    """s <- the step by the augmented multiplier method; returns the iterations, negative where it has not settled.

    J (3, 4); e (3,); weight, g, s (4,); lo, hi (4,) bounds of the step; room (MULTIPLIER_ROWS, 5) to work in.
    tuning: penalty, growth, max_penalty, residual, max_iterations.
    """
    r = tuning[0]
    residual = tuning[3]
    P = room[PRODUCTS : PRODUCTS + 4]
    K = room[SYSTEM : SYSTEM + 4]
    b = room[SYSTEM : SYSTEM + 4, 4]
    for i in range(5):
        room[EQUALITY, i] = 0.0
        room[LOWER, i] = 0.0
        room[UPPER, i] = 0.0
    for i in range(4):
        s[i] = 0.0
        P[i, 4] = J[0, i] * e[0] + J[1, i] * e[1] + J[2, i] * e[2]
        for j in range(i + 1):
            P[i, j] = J[0, i] * J[0, j] + J[1, i] * J[1, j] + J[2, i] * J[2, j]
    active = active_bounds(room, r, lo, hi, s)
    changes = 0
    for iteration in range(1, int(tuning[4]) + 1):
        rest = active
        for i in range(4):
            b[i] = weight[i] * g[i] + r * P[i, 4]
            for k in range(3):
                b[i] -= J[k, i] * room[EQUALITY, k]
            for j in range(i + 1):
                K[i, j] = r * P[i, j]
            K[i, i] += weight[i]
            if rest % 3 == 1:
                K[i, i] += r
                b[i] += r * lo[i] + room[LOWER, i]
            elif rest % 3 == 2:
                K[i, i] += r
                b[i] += r * hi[i] - room[UPPER, i]
            rest //= 3
        if not solve_symmetric(K, b, 4):
            return -iteration
        for i in range(4):
            s[i] = b[i]
        # Multipliers answer for a minimum of M only where the bounds reckoned with are those that count there.
        before = active
        active = active_bounds(room, r, lo, hi, s)
        if active != before and changes < MOST_CHANGES:
            changes += 1
            continue
        changes = 0
        worst = 0.0
        for k in range(3):
            h = J[k, 0] * s[0] + J[k, 1] * s[1] + J[k, 2] * s[2] + J[k, 3] * s[3] - e[k]
            room[EQUALITY, k] += r * h
            worst = max(worst, abs(h))
        for i in range(4):
            # Complementarity: a bound is kept, and its multiplier is zero unless it is met.
            above = s[i] - hi[i]
            below = lo[i] - s[i]
            worst = max(worst, abs(max(above, -room[UPPER, i] / r)), abs(max(below, -room[LOWER, i] / r)))
            room[UPPER, i] = max(0.0, room[UPPER, i] + r * above)
            room[LOWER, i] = max(0.0, room[LOWER, i] + r * below)
        if worst <= residual:
            return iteration
        r = min(r * tuning[1], tuning[2])
        active = active_bounds(room, r, lo, hi, s)
    return -int(tuning[4])


@inner
def reaches(J: Array, s: Array, e: Array, residual: float) -> bool:
    """Whether the step s (4,) makes the increment e (3,) [rad], to a thousandth of it or the residual."""
    for k in range(3):
        gap = J[k, 0] * s[0] + J[k, 1] * s[1] + J[k, 2] * s[2] + J[k, 3] * s[3] - e[k]
        if abs(gap) > max(residual, 1e-3 * abs(e[k])):
            return False
    return True


@inner
def possible(
    J: Array, manipulability: float, weight: Array, nowhere: Array, e: Array, work: Array, residual: float
) -> bool:
    """Whether a step inside the box makes the increment e (3,) [rad], by the closed form; work[POSE] is filled.

    `nowhere`: zeros (4,), for work[LO] and work[HI] are bounds of the step; residual as in `reaches`.
    """
    step = work[POSE]
    return quadratic_step(
        J, work[NULL], manipulability, weight, nowhere, work[INCREMENT], e, work[LO], work[HI], work[TOLERANCE], step
    ) and reaches(J, step, e, residual)


@inner
def hold_inner(horizontal: bool, G: Array, work: Array) -> None:
    """work[POSE] <- the exact pose for G (3, 3) with the inner angle of work[POSE], where that lies inside the box."""
    y = work[GUESS]
    project_inner(horizontal, G, work[POSE], y)
    if inside(y, work[LO], work[HI], work[TOLERANCE]):
        for i in range(4):
            work[POSE, i] = y[i]


@kernel
def alm_block(
    horizontal: bool,
    axes: Integers,
    table: Array,
    gains: Array,
    tuning: Array,
    mode: int,
    time: Array,
    attitude: Array,
    state: Array,
    target: Array,
    angles: Array,
    limited: Codes,
    iterations: Counts,
) -> None:
    """Advance `state` over m samples: time (m,), attitude (m, 3, 3) in; angles (m, 4), limited, iterations (m,) out.

    gains: avoidance, centring, homing, recovery; tuning: of `multiplier_step`; mode: a `Mode` by its place.
    """
    work = np.empty((ROWS, 4))
    room = np.empty((MULTIPLIER_ROWS, 5))
    A = np.empty((4, 5))
    J = np.empty((3, 4))
    F = np.empty((3, 3))
    G = np.empty((3, 3))
    e = np.empty(3)
    lo_code = np.empty(4, np.int16)
    hi_code = np.empty(4, np.int16)
    nowhere = np.zeros(4)
    d = state[0:4]
    for k in range(time.shape[0]):
        C = attitude[k]
        if state[PHASE] == FRESH:
            iterations[k] = 0
            code = int(state[CODE])
            for i in range(4):
                work[POSE, i] = d[i]
        else:
            h = time[k] - state[CLOCK]
            prepare(table, state, h, work, lo_code, hi_code)
            null_space_increment(table, d, h, gains, work[INCREMENT])
            manipulability = four_axis_pose(horizontal, d, F, J, work[NULL])
            if mode != OPEN_LOOP:
                on_target = goal_from(table, axes, state, target, C, h, gains[3], F, G, e)
            else:
                on_target = int(state[CODE]) == EXACT or rotation_error(F, target, e) <= HELD
                rotation_error(C, target, e)
            for i in range(4):
                work[LO, i] -= d[i]
                work[HI, i] -= d[i]
            count = multiplier_step(J, table[WEIGHT], work[INCREMENT], e, work[LO], work[HI], tuning, room, work[STEP])
            iterations[k] = abs(count)
            code = EXACT
            # Not settled: at the cap, or because no step inside the box has this increment.
            if (
                count < 0
                and mode != EXACT_CURVE
                and not possible(J, manipulability, table[WEIGHT], nowhere, e, work, tuning[3])
            ):
                for i in range(4):
                    work[DAMPING, i] = (SHIFT + squared_damping(manipulability)) * table[WEIGHT, i]
                binding = box_least_squares(J, e, work[DAMPING], work[INCREMENT], work[LO], work[HI], work[STEP], A)
                code = binding_code(binding, lo_code, hi_code)
                if code == EXACT and not reaches(J, work[STEP], e, tuning[3]):
                    code = outermost_code(work[STEP], work[LO], work[HI], lo_code, hi_code)
            for i in range(4):
                work[LO, i] += d[i]
                work[HI, i] += d[i]
                work[GUESS, i] = d[i] + work[STEP, i]
                # Within the residual the settled step may be outside its box; the limits hold to the last digit.
                work[POSE, i] = min(max(work[GUESS, i], work[LO, i]), work[HI, i])
            if mode == EXACT_CURVE:
                _, code = finish(horizontal, axes, table, state, on_target, G, J, e, F, work, A, lo_code, hi_code)
            elif code == EXACT:
                if mode == EXACT_INNER:
                    hold_inner(horizontal, G, work)
                if not on_target:
                    code = int(state[CODE])
        for i in range(4):
            angles[k, i] = work[POSE, i]
        limited[k] = code
        advance(state, target, time[k], work[POSE], code, C)


class AlmStepper:
    """One flight in progress with `alm`."""

    def __init__(self, rig: Rig, options: AlmOptions, start: Array | None, attitude: Array) -> None:
        if not rig.geometry.redundant:
            raise MethodError(f"alm needs the fourth axis; {rig.name} is {rig.geometry.value}: use three_axis")
        self._rig = rig
        self._mode = list(Mode).index(options.mode)
        self._table = limit_table(rig)
        self._gains = np.array([options.avoidance, options.centring, options.homing, options.recovery])
        self._tuning = np.array(
            [options.penalty, options.growth, options.max_penalty, options.residual, options.max_iterations]
        )
        self._state = new_state(*start_pose(rig, attitude, start))
        self._target = np.array(attitude, order="C")

    def begin_at_rest(self, dt: float) -> None:
        """Stand at the start pose at time 0, `dt` [s] after standing there; without it the first rate is free."""
        hold_position(self._state, dt)

    def block(self, time: Array, attitude: Array) -> Block:
        """Advance over samples: time (m,) [s], attitude (m, 3, 3)."""
        m = len(time)
        out = Block(np.empty((m, 4)), np.empty(m, np.int16), np.empty(m, np.int32))
        alm_block(
            self._rig.geometry.horizontal,
            self._rig.axes,
            self._table,
            self._gains,
            self._tuning,
            self._mode,
            time,
            attitude,
            self._state,
            self._target,
            out.angles,
            out.limited,
            out.iterations,
        )
        return out


METHOD = StepMethod(
    name="alm",
    source="Zhao et al. 2025, doi 10.19306/j.cnki.2095-8110.2025.03.014",
    claims_limits=True,
    options=AlmOptions,
    stepper=AlmStepper,
)
