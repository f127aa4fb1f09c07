"""What `exact` and `alm` share: the state of a flight in progress, the exact pose inside the box, and recovery.

A step method proposes a pose from the linearised programme; `settle` puts it on the self-motion curve of the target
and slides it along the curve until it lies inside the box, so that the sample is exact and inside every limit, or
says that it cannot; `give_way` then makes the attitude error as small as the limits allow.

Recovery. A sample that was limited leaves an error behind. Closing it at once would arrive with a closing rate that no
frame can brake, overshoot and swing on its acceleration limits. So the error is closed like a frame approaches its
stop: along the rate from which a set share of the smallest frame acceleration still brakes (`limits.approach_rate`).
"""

import math

import numpy as np

from fullpose._jit import inlined, inner
from fullpose._typing import Array, Codes, Integers
from fullpose.charts import project
from fullpose.kinematics import four_axis_pose, payload_attitude, rotation_error, self_motion
from fullpose.limits import (
    ACCELERATION,
    HOME,
    MAX,
    MIN,
    WEIGHT,
    approach_rate,
    inside,
    limit_box,
    tolerances,
)
from fullpose.rig import Z
from fullpose.solution import EXACT
from fullpose.step import box_least_squares, clamp, null_interval, squared_damping

# State of a flight in progress, one array: d (4), v (4), then these; beside it `target`, the last attitude (3, 3)
PAST, CLOCK, PHASE, CODE = 8, 9, 10, 11  # interval just past [s], time [s], phase, code of the last sample
STATE = 12
FRESH, PLACED, MOVING = 0.0, 1.0, 2.0  # no sample yet; a pose but no rate; both

# Rows of the work array of one sample, (ROWS, 4)
LO, HI, TOLERANCE, INCREMENT, GUESS, POSE, NULL, STEP, DAMPING = range(9)
ROWS = 9

SLIDES = 8  # along the curve to the box; two or three do it, unless there is no way
ALONG = 1e-2  # [rad] a slide this long is worth another: what it leaves is of third order
SHIFT = 1e-7  # damping of the least squares relative to the Jacobian's squares: picks one of many minima


@inlined
def null_space_increment(table: Array, d: Array, h: float, gains: Array, out: Array) -> None:
    """out <- the increment the frames would make of their own over `h` [rad], by the first three gains.

    avoidance [rad/s]: away from the singularity, the gradient of 1/2 log (m + 0.1), m = sin^2 d2 + cos^2 d3.
    centring [rad/s]: away from the end stops, the cube of the distance from the middle of the range over its half.
    homing [1/s]: toward home.
    """
    avoidance = gains[0]
    for i in range(4):
        out[i] = -gains[2] * h * (d[i] - table[HOME, i]) if gains[2] > 0.0 else 0.0
        half = 0.5 * (table[MAX, i] - table[MIN, i])
        if gains[1] > 0.0 and half > 0.0 and half < np.inf:
            off = (d[i] - table[MIN, i]) / half - 1.0
            out[i] -= gains[1] * h * off * off * off
    if avoidance > 0.0:
        s2 = math.sin(d[1])
        c2 = math.cos(d[1])
        s3 = math.sin(d[2])
        c3 = math.cos(d[2])
        gain = avoidance * h / (s2 * s2 + c3 * c3 + 0.1)
        out[1] += gain * s2 * c2
        out[2] -= gain * c3 * s3


@inner
def rotate_back(e: Array, C: Array, G: Array) -> None:
    """G <- exp(-[e]x) C, the attitude whose rotation error against C is e. e (3,) [rad], C, G (3, 3)."""
    angle = math.sqrt(e[0] * e[0] + e[1] * e[1] + e[2] * e[2])
    if angle > 1e-8:
        a = math.sin(angle) / angle
        half = math.sin(0.5 * angle) / angle
        b = 2.0 * half * half
    else:
        a = 1.0
        b = 0.5
    for k in range(3):
        # Rodrigues on each column c: c - a e x c + b e x (e x c)
        c0 = C[0, k]
        c1 = C[1, k]
        c2 = C[2, k]
        x0 = e[1] * c2 - e[2] * c1
        x1 = e[2] * c0 - e[0] * c2
        x2 = e[0] * c1 - e[1] * c0
        G[0, k] = c0 - a * x0 + b * (e[1] * x2 - e[2] * x1)
        G[1, k] = c1 - a * x1 + b * (e[2] * x0 - e[0] * x2)
        G[2, k] = c2 - a * x2 + b * (e[0] * x1 - e[1] * x0)


@inlined
def goal_from(
    table: Array,
    axes: Integers,
    state: Array,
    target: Array,
    C: Array,
    h: float,
    recovery: float,
    F: Array,
    G: Array,
    e: Array,
) -> bool:
    """G <- the attitude to go for at the next sample: C, or on the way back to it; e <- the increment to G [rad].

    F (3, 3) is the attitude now. Returns whether G is C. recovery: share of the smallest frame acceleration.
    """
    recovering = False
    if state[CODE] != EXACT:
        behind = rotation_error(F, target, e)
        slowest = np.inf
        for i in range(4):
            if axes[i] >= 0:
                slowest = min(slowest, table[ACCELERATION, i])
        closing = h * approach_rate(behind, recovery * slowest, h)
        if closing < behind * (1.0 - 1e-9):
            for i in range(3):
                e[i] *= 1.0 - closing / behind
            rotate_back(e, C, G)
            recovering = True
    if not recovering:
        for i in range(3):
            for j in range(3):
                G[i, j] = C[i, j]
    rotation_error(G, F, e)
    return not recovering


@inner
def goal(
    table: Array,
    axes: Integers,
    state: Array,
    target: Array,
    C: Array,
    h: float,
    recovery: float,
    F: Array,
    G: Array,
    e: Array,
) -> bool:
    """`goal_from` with F <- the attitude now."""
    payload_attitude(axes, state[0:4], F)
    return goal_from(table, axes, state, target, C, h, recovery, F, G, e)


@inner
def settle(horizontal: bool, weight: Array, d: Array, G: Array, work: Array) -> int:
    """work[POSE] <- the exact pose for G inside the box nearest to d + g (weighted), from work[GUESS].

    Returns how many times the pose was slid along the curve; 0 where no pose inside the box was found.
    """
    y = work[POSE]
    n = work[NULL]
    lo = work[LO]
    hi = work[HI]
    project(horizontal, G, work[GUESS], y)
    for k in range(1, SLIDES + 1):
        self_motion(horizontal, y, n)
        along = 0.0
        norm = 0.0
        for i in range(4):
            along += n[i] * weight[i] * (d[i] + work[INCREMENT, i] - y[i])
            norm += n[i] * weight[i] * n[i]
        z_min, z_max = null_interval(y, n, lo, hi, work[TOLERANCE])
        z = clamp(along / norm if norm > 0.0 else 0.0, z_min, z_max)
        for i in range(4):
            y[i] += n[i] * z
        project(horizontal, G, y, y)
        if abs(z) < ALONG and inside(y, lo, hi, work[TOLERANCE]):
            return k
    return 0


@inner
def binding_code(binding: int, lo_code: Codes, hi_code: Codes) -> int:
    """The `limited_code` of a bound as `box_least_squares` numbers them; `EXACT` where none binds."""
    if binding == 0:
        return EXACT
    frame = (binding - 1) // 2
    return int(hi_code[frame] if (binding - 1) % 2 == 1 else lo_code[frame])


@inner
def outermost_code(x: Array, lo: Array, hi: Array, lo_code: Codes, hi_code: Codes) -> int:
    """The `limited_code` of the bound that x (4,) is farthest beyond."""
    farthest = -np.inf
    code = int(hi_code[0])
    for i in range(4):
        if lo[i] - x[i] > farthest:
            farthest = lo[i] - x[i]
            code = int(lo_code[i])
        if x[i] - hi[i] > farthest:
            farthest = x[i] - hi[i]
            code = int(hi_code[i])
    return code


@inner
def give_way(
    axes: Integers,
    table: Array,
    d: Array,
    G: Array,
    J: Array,
    e: Array,
    F: Array,
    work: Array,
    A: Array,
    lo_code: Codes,
    hi_code: Codes,
) -> int:
    """work[GUESS] <- the pose inside the box with the least attitude error against G; returns the code of what binds.

    Two Gauss-Newton steps. `EXACT` where no bound holds it back.
    """
    binding = 0
    x = work[GUESS]
    for i in range(4):
        x[i] = d[i]
    for again in range(2):
        manipulability = four_axis_pose(axes[0] == Z, x, F, J, work[NULL])
        rotation_error(G, F, e)
        for i in range(4):
            work[DAMPING, i] = (SHIFT + squared_damping(manipulability)) * table[WEIGHT, i]
            work[LO, i] -= x[i]
            work[HI, i] -= x[i]
            work[INCREMENT, i] += d[i] - x[i]
        now = box_least_squares(J, e, work[DAMPING], work[INCREMENT], work[LO], work[HI], work[STEP], A)
        if now > 0 or again == 0:
            binding = now
        for i in range(4):
            work[LO, i] += x[i]
            work[HI, i] += x[i]
            work[INCREMENT, i] += x[i] - d[i]
            x[i] = min(max(x[i] + work[STEP, i], work[LO, i]), work[HI, i])
    return binding_code(binding, lo_code, hi_code)


@inner
def finish(
    horizontal: bool,
    axes: Integers,
    table: Array,
    state: Array,
    on_target: bool,
    G: Array,
    J: Array,
    e: Array,
    F: Array,
    work: Array,
    A: Array,
    lo_code: Codes,
    hi_code: Codes,
) -> tuple[int, int]:
    """work[POSE] <- the sample, from the method's proposal work[GUESS]; returns (slides along the curve, code)."""
    d = state[0:4]
    slides = settle(horizontal, table[WEIGHT], d, G, work)
    code = EXACT
    if slides == 0:
        missed = outermost_code(work[POSE], work[LO], work[HI], lo_code, hi_code)
        code = give_way(axes, table, d, G, J, e, F, work, A, lo_code, hi_code)
        if code == EXACT:
            code = missed  # next to the singularity the frames may be free to move and yet not get there
        # The nearest pose may be exact after all, where it was only the way to it that missed the box.
        slides = settle(horizontal, table[WEIGHT], d, G, work)
        if slides == 0:
            for i in range(4):
                work[POSE, i] = work[GUESS, i]
    if slides > 0:
        code = EXACT if on_target else int(state[CODE])  # on the way back: what made it leave
    return slides, code


@inlined
def advance(state: Array, target: Array, time: float, x: Array, code: int, C: Array) -> None:
    """Take the sample x (4,) [rad] at `time` [s] into the state; `code` is its mark, C (3, 3) its target."""
    h = time - state[CLOCK]
    if state[PHASE] != FRESH:
        for i in range(4):
            state[4 + i] = (x[i] - state[i]) / h
        state[PAST] = h
        state[PHASE] = MOVING
    else:
        state[PHASE] = PLACED
    for i in range(4):
        state[i] = x[i]
    state[CLOCK] = time
    state[CODE] = code
    for i in range(3):
        for j in range(3):
            target[i, j] = C[i, j]


@inlined
def prepare(table: Array, state: Array, h: float, work: Array, lo_code: Codes, hi_code: Codes) -> None:
    """work[LO], work[HI], work[TOLERANCE] <- the box of the next sample, `h` [s] ahead."""
    past = state[PAST] if state[PHASE] == MOVING else 0.0
    limit_box(table, state[0:4], state[4:8], past, h, work[LO], work[HI], lo_code, hi_code)
    tolerances(table, past, h, work[TOLERANCE])


def new_state(pose: Array, code: int) -> Array:
    """The state of a flight that starts at `pose` (4,) [rad], marked `code`. (STATE,)"""
    state = np.zeros(STATE)
    state[:4] = pose
    state[PHASE] = FRESH
    state[CODE] = code
    return state


def hold_position(state: Array, dt: float) -> None:
    """The flight stands at its pose since `dt` [s] before time 0: the rate of its first sample is no longer free."""
    state[4:8] = 0.0
    state[PAST] = dt
    state[CLOCK] = 0.0
    state[PHASE] = MOVING
