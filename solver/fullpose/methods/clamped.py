"""`clamped`: clamping weighted least norm: a frame at its limit is locked, the others are re-solved.

mathematics, section 7.

Source: Huang 2014. The least-norm step is taken; the frame that leaves its range by most is put on the bound and locked
(its inverse weight zero), and the step is taken again by the frames still free, with what the locked ones contribute
taken off the increment. The paper locks at position limits. Here the ranges are `fullpose.limits.limit_box`, so that
rates, accelerations and the distance to brake are clamped as well, and the method claims all of the rig's limits.

Each sample iterates to the target attitude. Where a sample's frames left free cannot reach it, the sample is marked
with the frame that was locked first and the limit that set its bound; on the way back, where nothing is locked, with
what made it leave.

Three frames left free have a pole of their own, where no least-squares step turns them about the axis that is lost:
they would stand there, free to move, for the rest of the flight. There they are re-solved in closed form
(`tracking.settle`), if that pose is inside the ranges. That is ours: the paper's frames are not locked for so long.
"""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fullpose._jit import inner, kernel
from fullpose._typing import Array, Codes, Counts, Integers
from fullpose.kinematics import jacobian, null_vector, payload_attitude, rotation_error
from fullpose.limits import WEIGHT, limit_table
from fullpose.methods.base import Block, StepMethod, Stepper
from fullpose.methods.start_pose import start_pose
from fullpose.methods.state import (
    CLOCK,
    CODE,
    FRESH,
    GUESS,
    HI,
    INCREMENT,
    LO,
    PHASE,
    POSE,
    ROWS,
    advance,
    binding_code,
    goal,
    hold_position,
    new_state,
    prepare,
    settle,
)
from fullpose.methods.unlimited import require_fourth_axis
from fullpose.options import Options, ranged
from fullpose.rig import Rig
from fullpose.solution import EXACT
from fullpose.step import DAMPED_BELOW, solve_symmetric, squared_damping

HELD = math.radians(1e-9)  # a sample within this of the attitude is not limited; nor one within the tolerance
LONGEST = 1.0  # [rad] a frame in one iteration; longer steps are damped, then shortened
LOCKED_DAMPING = 1e-12  # shares the step between two free frames with parallel axes


@dataclass(frozen=True)
class ClampedOptions(Options):
    """tolerance [rad] and cap of the iteration to the target; each takes up to four lockings.

    recovery: share of the smallest frame acceleration that brakes the return to the attitude after a limited sample,
    as in `exact`; not in the paper, whose frames have no accelerations to keep.
    """

    tolerance: float = ranged(1e-14, 0.0, 1.0)
    max_iterations: int = ranged(8, 1, 1000)
    recovery: float = ranged(0.5, 0.0, 1.0, open=True)


@kernel
def free_step(J: Array, weight: Array, free: NDArray[np.bool_], e: Array, damping: float, A: Array, p: Array) -> None:
    """p <- the free frames' least-norm step for e; with two or fewer free, their least-squares one.

    The entries of the locked frames are left. J (3, 4); weight, free, p (4,); e (3,); A (3, 4) is room to work in.
    """
    y = A[:, 3]
    count = 0
    for i in range(4):
        if free[i]:
            count += 1
    if count > 2:
        # W^-1 J^T (J W^-1 J^T + damping I)^-1 e
        for r in range(3):
            y[r] = e[r]
            for c in range(r + 1):
                A[r, c] = damping if r == c else 0.0
                for i in range(4):
                    if free[i]:
                        A[r, c] += J[r, i] * J[c, i] / weight[i]
        solved = solve_symmetric(A, y, 3)
        for i in range(4):
            if free[i]:
                p[i] = (J[0, i] * y[0] + J[1, i] * y[1] + J[2, i] * y[2]) / weight[i] if solved else 0.0
        return
    # (J^T J + damping W)^-1 J^T e over the free columns: the other form has no inverse with fewer columns than rows.
    m = 0
    for i in range(4):
        if not free[i]:
            continue
        y[m] = J[0, i] * e[0] + J[1, i] * e[1] + J[2, i] * e[2]
        k = 0
        for j in range(i + 1):
            if free[j]:
                A[m, k] = J[0, i] * J[0, j] + J[1, i] * J[1, j] + J[2, i] * J[2, j]
                k += 1
        A[m, m] += LOCKED_DAMPING * weight[i]
        m += 1
    solved = solve_symmetric(A, y, m)
    m = 0
    for i in range(4):
        if free[i]:
            p[i] = y[m] if solved else 0.0
            m += 1


@kernel
def clamped_step(
    J: Array,
    manipulability: float,
    minors: Array,
    weight: Array,
    e: Array,
    lo: Array,
    hi: Array,
    free: NDArray[np.bool_],
    A: Array,
    p: Array,
) -> int:
    """p <- the step in [lo, hi] by locking the frame that leaves by most; returns the first bound locked, or 0.

    A bound is 1 + 2 frame + (1 at the upper one). manipulability: of J; minors (4,): of the three frames
    left without each, or infinite where their step is not to be damped. lo, hi, p (4,) are of the step; free (4,) and
    A (3, 4) are filled.
    """
    r = np.empty(3)
    first = 0
    damping = squared_damping(manipulability)
    for i in range(4):
        free[i] = True
    locked = 0
    while True:
        for k in range(3):
            r[k] = e[k]
            for i in range(4):
                if not free[i]:
                    r[k] -= J[k, i] * p[i]
        free_step(J, weight, free, r, damping, A, p)
        worst = 0.0
        out = -1
        for i in range(4):
            if free[i]:
                excess = max(lo[i] - p[i], p[i] - hi[i])
                if excess > worst:
                    worst = excess
                    out = i
        if out < 0:
            return first
        upper = p[out] > hi[out]
        p[out] = hi[out] if upper else lo[out]
        free[out] = False
        locked += 1
        damping = squared_damping(min(manipulability, minors[out]))
        if first == 0:
            first = 1 + 2 * out + (1 if upper else 0)
        if locked == 4:
            return first


@inner
def longest_of(p: Array) -> float:
    """The largest magnitude of p (4,)."""
    longest = 0.0
    for i in range(4):
        longest = max(longest, abs(p[i]))
    return longest


@kernel
def at_pole(J: Array, n: Array, free: NDArray[np.bool_]) -> bool:
    """Whether three frames are free and next to their own pole. J (3, 4), n (4,) <- its null vector, free (4,)."""
    manipulability = null_vector(J, n)
    locked = -1
    for i in range(4):
        if not free[i]:
            if locked >= 0:
                return False
            locked = i
    return locked >= 0 and manipulability * abs(n[locked]) < DAMPED_BELOW


@kernel
def clamped_block(
    horizontal: bool,
    axes: Integers,
    table: Array,
    parameters: Array,
    time: Array,
    attitude: Array,
    state: Array,
    target: Array,
    angles: Array,
    limited: Codes,
    iterations: Counts,
) -> None:
    """Advance `state` (see `tracking`) over m samples. Parameters: tolerance, cap, recovery."""
    work = np.empty((ROWS, 4))
    F = np.empty((3, 3))
    G = np.empty((3, 3))
    J = np.empty((3, 4))
    A = np.empty((3, 4))
    n = np.empty(4)
    e = np.empty(3)
    p = np.empty(4)
    lo = np.empty(4)
    hi = np.empty(4)
    free = np.empty(4, np.bool_)
    undamped = np.full(4, np.inf)
    lo_code = np.empty(4, np.int16)
    hi_code = np.empty(4, np.int16)
    for k in range(time.shape[0]):
        C = attitude[k]
        x = angles[k]
        for i in range(4):
            x[i] = state[i]
        code = EXACT
        iterations[k] = 0
        if state[PHASE] == FRESH:
            code = int(state[CODE])
        else:
            h = time[k] - state[CLOCK]
            prepare(table, state, h, work, lo_code, hi_code)
            on_target = goal(table, axes, state, target, C, h, parameters[2], F, G, e)
            bound = 0
            for again in range(int(parameters[1])):
                payload_attitude(axes, x, F)
                # At least one step: the pose may be on target where its rate does not let it stay.
                if rotation_error(G, F, e) <= parameters[0] and again > 0:
                    break
                jacobian(axes, x, J)
                for i in range(4):
                    lo[i] = work[LO, i] - x[i]
                    hi[i] = work[HI, i] - x[i]
                manipulability = null_vector(J, n)
                now = clamped_step(J, manipulability, undamped, table[WEIGHT], e, lo, hi, free, A, p)
                longest = longest_of(p)
                if longest > LONGEST:
                    # Next to the pole of the frames left, which without rate limits nothing else keeps short.
                    for i in range(4):
                        n[i] = manipulability * abs(n[i])
                    now = clamped_step(J, manipulability, n, table[WEIGHT], e, lo, hi, free, A, p)
                    longest = longest_of(p)
                if bound == 0:
                    bound = now
                for i in range(4):
                    x[i] = min(max(x[i] + p[i] * min(1.0, LONGEST / longest), work[LO, i]), work[HI, i])
                iterations[k] += 1
            payload_attitude(axes, x, F)
            held = max(HELD, parameters[0])
            if rotation_error(G, F, e) > held and at_pole(J, n, free):
                for i in range(4):
                    work[GUESS, i] = x[i]
                    work[INCREMENT, i] = 0.0
                if settle(horizontal, table[WEIGHT], state[0:4], G, work) > 0:
                    for i in range(4):
                        x[i] = work[POSE, i]
                    bound = 0
                    payload_attitude(axes, x, F)
            if rotation_error(C, F, e) > held:
                if bound > 0:
                    code = binding_code(bound, lo_code, hi_code)
                elif not on_target:
                    code = int(state[CODE])
        limited[k] = code
        advance(state, target, time[k], x, code, C)


class ClampedStepper:
    """One flight in progress with `clamped`."""

    def __init__(self, rig: Rig, options: ClampedOptions, start: Array | None, attitude: Array) -> None:
        require_fourth_axis("clamped", rig)
        self._rig = rig
        self._table = limit_table(rig)
        self._parameters = np.array([options.tolerance, float(options.max_iterations), options.recovery])
        self._state = new_state(*start_pose(rig, attitude, start))
        self._target = np.array(attitude, order="C")

    def begin_at_rest(self, dt: float) -> None:
        """Stand at the start pose at time 0, `dt` [s] after standing there; without it the first rate is free."""
        hold_position(self._state, dt)

    def block(self, time: Array, attitude: Array) -> Block:
        """Advance over samples: time (m,) [s], attitude (m, 3, 3)."""
        m = len(time)
        out = Block(np.empty((m, 4)), np.empty(m, np.int16), np.empty(m, np.int32))
        clamped_block(
            self._rig.geometry.horizontal,
            self._rig.axes,
            self._table,
            self._parameters,
            time,
            np.ascontiguousarray(attitude),
            self._state,
            self._target,
            out.angles,
            out.limited,
            out.iterations,
        )
        return out


def _stepper(rig: Rig, options: ClampedOptions, start: Array | None, attitude: Array) -> Stepper:
    return ClampedStepper(rig, options, start, attitude)


METHOD = StepMethod(
    name="clamped",
    source="Huang 2014, clamping weighted least norm",
    claims_limits=True,
    options=ClampedOptions,
    stepper=_stepper,
)
