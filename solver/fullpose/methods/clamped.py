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
(`limited.settle`), if that pose is inside the ranges. That is ours: the paper's frames are not locked for so long.
"""

import math
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from fullpose._jit import inner
from fullpose._typing import Array, Flags
from fullpose.bounds import EXACT
from fullpose.kinematics import jacobian, null_vector, payload_attitude, rotation_error
from fullpose.least_squares import DAMPED_BELOW, solve_symmetric, squared_damping
from fullpose.methods.base import StepMethod, Stepper
from fullpose.methods.block import block_kernel
from fullpose.methods.limited import Gains, LimitedStepper, binding_code, flight_from, goal, settle
from fullpose.methods.state import Flight, box_ahead
from fullpose.options import Options, ranged
from fullpose.rig import Rig

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


class Locks(Protocol):
    """What a sample's lockings work with, as `LOCKS` lays it out."""

    tolerance: float  # [rad]
    max_iterations: int
    minors: Array  # (4,) manipulability of the three frames left without each; infinite: their step is not damped
    lo: Array  # (4,) [rad] bounds of the step
    hi: Array
    free: Flags  # (4,) the frames that are not locked
    step: Array  # (4,) [rad]
    rest: Array  # (3,) [rad] what the locked frames leave of the increment
    system: Array  # (3, 4)


LOCKS = np.dtype(
    (
        np.record,
        np.dtype(
            [
                ("tolerance", "f8"), ("max_iterations", "i8"), ("minors", "f8", 4), ("lo", "f8", 4), ("hi", "f8", 4),
                ("free", "u1", 4), ("step", "f8", 4), ("rest", "f8", 3), ("system", "f8", (3, 4)),
            ],
            align=True,
        ),
    )
)  # fmt: skip


@inner
def free_step(J: Array, weight: Array, damping: float, locks: Locks) -> None:
    """step <- the free frames' least-norm step for the rest; with two or fewer free, their least-squares one.

    The entries of the locked frames are left. J (3, 4); weight (4,).
    """
    A = locks.system
    y = A[:, 3]
    free = locks.free
    count = 0
    for i in range(4):
        if free[i]:
            count += 1
    if count > 2:
        # W^-1 J^T (J W^-1 J^T + damping I)^-1 e
        for r in range(3):
            y[r] = locks.rest[r]
            for c in range(r + 1):
                A[r, c] = damping if r == c else 0.0
                for i in range(4):
                    if free[i]:
                        A[r, c] += J[r, i] * J[c, i] / weight[i]
        solved = solve_symmetric(A, y, 3)
        for i in range(4):
            if free[i]:
                locks.step[i] = (J[0, i] * y[0] + J[1, i] * y[1] + J[2, i] * y[2]) / weight[i] if solved else 0.0
        return
    # (J^T J + damping W)^-1 J^T e over the free columns: the other form has no inverse with fewer columns than rows.
    m = 0
    for i in range(4):
        if not free[i]:
            continue
        y[m] = J[0, i] * locks.rest[0] + J[1, i] * locks.rest[1] + J[2, i] * locks.rest[2]
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
            locks.step[i] = y[m] if solved else 0.0
            m += 1


@inner
def clamped_step(J: Array, manipulability: float, weight: Array, e: Array, locks: Locks) -> int:
    """step <- the one in [lo, hi] by locking the frame that leaves by most; returns the first bound locked, or 0.

    A bound is 1 + 2 frame + (1 at the upper one). J (3, 4) and its manipulability; weight (4,); e (3,). The bounds and
    minors of the locks are read, the rest of them is filled.
    """
    p = locks.step
    first = 0
    damping = squared_damping(manipulability)
    for i in range(4):
        locks.free[i] = True
    locked = 0
    while True:
        for k in range(3):
            locks.rest[k] = e[k]
            for i in range(4):
                if not locks.free[i]:
                    locks.rest[k] -= J[k, i] * p[i]
        free_step(J, weight, damping, locks)
        farthest = 0.0
        out = -1
        for i in range(4):
            if locks.free[i]:
                violation = max(locks.lo[i] - p[i], p[i] - locks.hi[i])
                if violation > farthest:
                    farthest = violation
                    out = i
        if out < 0:
            return first
        upper = p[out] > locks.hi[out]
        p[out] = locks.hi[out] if upper else locks.lo[out]
        locks.free[out] = False
        locked += 1
        damping = squared_damping(min(manipulability, locks.minors[out]))
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


@inner
def at_pole(J: Array, n: Array, locks: Locks) -> bool:
    """Whether three frames are free and next to their own pole. J (3, 4), n (4,) <- its null vector."""
    manipulability = null_vector(J, n)
    locked = -1
    for i in range(4):
        if not locks.free[i]:
            if locked >= 0:
                return False
            locked = i
    return locked >= 0 and manipulability * abs(n[locked]) < DAMPED_BELOW


@inner
def iterate(flight: Flight, locks: Locks) -> int:
    """next += one clamped step toward the goal, e the error now; returns the first bound locked, or 0."""
    x = flight.next
    weight = flight.weight
    jacobian(flight.axes, x, flight.J)
    for i in range(4):
        locks.lo[i] = flight.lo[i] - x[i]
        locks.hi[i] = flight.hi[i] - x[i]
        locks.minors[i] = np.inf
    manipulability = null_vector(flight.J, flight.null)
    bound = clamped_step(flight.J, manipulability, weight, flight.e, locks)
    longest = longest_of(locks.step)
    if longest > LONGEST:
        # Next to the pole of the frames left, which without rate limits nothing else keeps short.
        for i in range(4):
            locks.minors[i] = manipulability * abs(flight.null[i])
        bound = clamped_step(flight.J, manipulability, weight, flight.e, locks)
        longest = longest_of(locks.step)
    for i in range(4):
        x[i] = min(max(x[i] + locks.step[i] * min(1.0, LONGEST / longest), flight.lo[i]), flight.hi[i])
    return bound


@inner
def settle_at_pole(flight: Flight) -> bool:
    """next <- the closed form's pose from here, where it is inside the box; else next stays, and false."""
    for i in range(4):
        flight.guess[i] = flight.next[i]
        flight.increment[i] = 0.0
    if settle(flight) > 0:
        return True
    for i in range(4):
        flight.next[i] = flight.guess[i]
    return False


@inner
def clamped_sample(flight: Flight, parameters: Array, C: Array) -> tuple[int, int]:
    """See `block.propose`; parameters: (1,) `LOCKS`."""
    locks: Locks = parameters[0]
    box_ahead(flight)
    x = flight.next
    for i in range(4):
        x[i] = flight.pose[i]
    goal(flight, C)
    bound = 0
    count = 0
    for again in range(locks.max_iterations):
        payload_attitude(flight.axes, x, flight.F)
        # At least one step: the pose may be on target where its rate does not let it stay.
        if rotation_error(flight.goal, flight.F, flight.e) <= locks.tolerance and again > 0:
            break
        now = iterate(flight, locks)
        if bound == 0:
            bound = now
        count += 1
    payload_attitude(flight.axes, x, flight.F)
    held = max(HELD, locks.tolerance)
    if (
        rotation_error(flight.goal, flight.F, flight.e) > held
        and at_pole(flight.J, flight.null, locks)
        and settle_at_pole(flight)
    ):
        bound = 0
        payload_attitude(flight.axes, x, flight.F)
    code = EXACT
    if rotation_error(C, flight.F, flight.e) > held:
        if bound > 0:
            code = binding_code(flight, bound)
        elif not flight.on_target:
            code = int(flight.code)
    return count, code


clamped_block = block_kernel("clamped_block", clamped_sample)


def _stepper(rig: Rig, options: ClampedOptions, start: Array | None, attitude: Array) -> Stepper:
    locks = np.zeros(1, LOCKS)
    locks["tolerance"], locks["max_iterations"] = options.tolerance, options.max_iterations
    gains = Gains(0.0, 0.0, 0.0, options.recovery)
    return LimitedStepper(clamped_block, locks, gains, flight_from("clamped", rig, start, attitude))


METHOD = StepMethod(
    name="clamped",
    source="Huang 2014, clamping weighted least norm",
    claims_limits=True,
    options=ClampedOptions,
    stepper=_stepper,
)
