"""What the methods that keep limits share: the exact pose inside the box, recovery, the stepper.

A method proposes a pose from the linearised programme; `settle` puts it on the self-motion curve of the target and
slides it along the curve until it lies inside the box, so that the sample is exact and inside every limit, or says
that it cannot; `yield_attitude` then makes the attitude error as small as the limits allow.

Recovery. A sample that was limited leaves an error behind. Closing it at once would arrive with a closing rate that no
frame can brake, overshoot and swing on its acceleration limits. So the error is closed like a frame approaches its
stop: along the rate from which a set share of the smallest frame acceleration still brakes (`limits.approach_rate`).
"""

import math
from typing import Any, NamedTuple

import numpy as np

from fullpose._jit import inlined, inner
from fullpose._typing import Array
from fullpose.bounds import EXACT
from fullpose.charts import project
from fullpose.kinematics import four_axis_pose, payload_attitude, rotate_back, rotation_error, self_motion
from fullpose.least_squares import LeastSquares, box_least_squares, squared_damping
from fullpose.limits import ACCELERATION, HOME, MAX, MIN, approach_rate, inside
from fullpose.methods.block import BlockKernel, BlockStepper
from fullpose.methods.start_pose import require_fourth_axis, require_no_jerk_limits, start_pose
from fullpose.methods.state import Flight, hold_position, new_flight
from fullpose.rig import Rig
from fullpose.step import Programme, clamp, null_interval, quadratic_step

SLIDES = 8  # along the curve to the box; two or three do it, unless there is no way
ALONG = 1e-2  # [rad] a slide this long is worth another: what it leaves is of third order
SHIFT = 1e-7  # damping of the least squares relative to the Jacobian's squares: picks one of many minima


class Gains(NamedTuple):
    """Null-space gains: avoidance, centring [rad/s], homing [1/s]; recovery: share of the smallest acceleration."""

    avoidance: float
    centring: float
    homing: float
    recovery: float


@inlined
def null_space_increment(flight: Flight) -> None:
    """increment <- what the frames would do of their own over the interval ahead [rad], by the first three gains.

    avoidance [rad/s]: away from the singularity, the gradient of 1/2 log (m + 0.1), m = sin^2 d2 + cos^2 d3.
    centring [rad/s]: away from the end stops, the cube of the distance from the middle of the range over its half.
    homing [1/s]: toward home.
    """
    h = flight.ahead
    d = flight.pose
    out = flight.increment
    table = flight.limits
    for i in range(4):
        out[i] = -flight.homing * h * (d[i] - table[HOME, i]) if flight.homing > 0.0 else 0.0
        half = 0.5 * (table[MAX, i] - table[MIN, i])
        if flight.centring > 0.0 and half > 0.0 and half < np.inf:
            off = (d[i] - table[MIN, i]) / half - 1.0
            out[i] -= flight.centring * h * off * off * off
    if flight.avoidance > 0.0:
        s2 = math.sin(d[1])
        c2 = math.cos(d[1])
        s3 = math.sin(d[2])
        c3 = math.cos(d[2])
        gain = flight.avoidance * h / (s2 * s2 + c3 * c3 + 0.1)
        out[1] += gain * s2 * c2
        out[2] -= gain * c3 * s3


@inlined
def goal_from(flight: Flight, C: Array) -> None:
    """goal <- the attitude to go for at the next sample: C, or on the way back to it; e <- the increment to it [rad].

    F is the attitude now. `on_target`: whether the goal is C.
    """
    e = flight.e
    G = flight.goal
    flight.on_target = True
    if flight.code != EXACT:
        behind = rotation_error(flight.F, flight.target, e)
        slowest = np.inf
        for i in range(4):
            if flight.axes[i] >= 0:
                slowest = min(slowest, flight.limits[ACCELERATION, i])
        closing = flight.ahead * approach_rate(behind, flight.recovery * slowest, flight.ahead)
        if closing < behind * (1.0 - 1e-9):
            for i in range(3):
                e[i] *= 1.0 - closing / behind
            rotate_back(e, C, G)
            flight.on_target = False
    if flight.on_target:
        for i in range(3):
            for j in range(3):
                G[i, j] = C[i, j]
    rotation_error(G, flight.F, e)


@inner
def goal(flight: Flight, C: Array) -> None:
    """`goal_from` with F <- the attitude now."""
    payload_attitude(flight.axes, flight.pose, flight.F)
    goal_from(flight, C)


@inlined
def closed_form_step(flight: Flight, manipulability: float, d: Array, x: Array) -> bool:
    """x (4,) <- `quadratic_step` from d (4,) for the increment e: whether it satisfies the programme.

    Where lo and hi are bounds of the step, d is zero and x the step.
    """
    return quadratic_step(
        Programme(
            flight.J, flight.null, manipulability, flight.weight, d, flight.increment, flight.e,
            flight.lo, flight.hi, flight.tolerance,
        ),
        x,
    )  # fmt: skip


@inner
def settle(flight: Flight) -> int:
    """next <- the exact pose for the goal inside the box nearest to pose + increment (weighted), from the guess.

    Returns how many times the pose was slid along the curve; 0 where no pose inside the box was found.
    """
    y = flight.next
    n = flight.null
    project(flight.horizontal, flight.goal, flight.guess, y)
    for k in range(1, SLIDES + 1):
        self_motion(flight.horizontal, y, n)
        along = 0.0
        norm = 0.0
        for i in range(4):
            weight = flight.weight[i]
            along += n[i] * weight * (flight.pose[i] + flight.increment[i] - y[i])
            norm += n[i] * weight * n[i]
        z_min, z_max = null_interval(y, n, flight.lo, flight.hi, flight.tolerance)
        z = clamp(along / norm if norm > 0.0 else 0.0, z_min, z_max)
        for i in range(4):
            y[i] += n[i] * z
        project(flight.horizontal, flight.goal, y, y)
        if abs(z) < ALONG and inside(y, flight.lo, flight.hi, flight.tolerance):
            return k
    return 0


@inner
def binding_code(flight: Flight, binding: int) -> int:
    """The `limited_code` of a bound as `box_least_squares` numbers them; `EXACT` where none binds."""
    if binding == 0:
        return EXACT
    frame = (binding - 1) // 2
    return int(flight.hi_code[frame] if (binding - 1) % 2 == 1 else flight.lo_code[frame])


@inner
def outermost_code(flight: Flight, x: Array) -> int:
    """The `limited_code` of the bound of lo, hi that x (4,) is farthest beyond."""
    farthest = -np.inf
    code = int(flight.hi_code[0])
    for i in range(4):
        if flight.lo[i] - x[i] > farthest:
            farthest = flight.lo[i] - x[i]
            code = int(flight.lo_code[i])
        if x[i] - flight.hi[i] > farthest:
            farthest = x[i] - flight.hi[i]
            code = int(flight.hi_code[i])
    return code


@inlined
def shift_box(flight: Flight, x: Array, sign: float) -> None:
    """lo, hi += sign x (4,): from bounds of the pose to bounds of the step from x (-1), or back (+1)."""
    for i in range(4):
        flight.lo[i] += sign * x[i]
        flight.hi[i] += sign * x[i]


@inlined
def least_squares_step(flight: Flight, manipulability: float) -> int:
    """step <- the one in [lo, hi] that makes the increment e best; returns the costliest bound, see its callee."""
    for i in range(4):
        flight.damping[i] = (SHIFT + squared_damping(manipulability)) * flight.weight[i]
    problem = LeastSquares(flight.J, flight.e, flight.damping, flight.increment, flight.lo, flight.hi)
    return box_least_squares(problem, flight.step, flight.system)


@inner
def yield_attitude(flight: Flight) -> int:
    """guess <- the pose inside the box with the least attitude error against the goal; returns the code of what binds.

    Two Gauss-Newton steps. `EXACT` where no bound holds it back.
    """
    binding = 0
    x = flight.guess
    for i in range(4):
        x[i] = flight.pose[i]
    for again in range(2):
        manipulability = four_axis_pose(flight.horizontal, x, flight.F, flight.J, flight.null)
        rotation_error(flight.goal, flight.F, flight.e)
        for i in range(4):
            flight.increment[i] += flight.pose[i] - x[i]
        shift_box(flight, x, -1.0)
        now = least_squares_step(flight, manipulability)
        if now > 0 or again == 0:
            binding = now
        shift_box(flight, x, 1.0)
        for i in range(4):
            flight.increment[i] += x[i] - flight.pose[i]
            x[i] = min(max(x[i] + flight.step[i], flight.lo[i]), flight.hi[i])
    return binding_code(flight, binding)


@inner
def finish(flight: Flight) -> tuple[int, int]:
    """next <- the sample, from the method's guess; returns (slides along the curve, code)."""
    slides = settle(flight)
    code = EXACT
    if slides == 0:
        missed = outermost_code(flight, flight.next)
        code = yield_attitude(flight)
        if code == EXACT:
            code = missed  # next to the singularity the frames may be free to move and yet not get there
        # The nearest pose may be exact after all, where it was only the way to it that missed the box.
        slides = settle(flight)
        if slides == 0:
            for i in range(4):
                flight.next[i] = flight.guess[i]
    if slides > 0:
        code = EXACT if flight.on_target else int(flight.code)  # on the way back: what made it leave
    return slides, code


class LimitedStepper(BlockStepper):
    """One flight in progress with a method that keeps limits."""

    def __init__(self, block: BlockKernel, parameters: Any, gains: Gains, flight: Flight) -> None:
        super().__init__(block, parameters, flight)
        for name, gain in gains._asdict().items():
            self._flights[name] = gain

    def begin_at_rest(self, dt: float) -> None:
        """Stand at the start pose at time 0, `dt` [s] after standing there; without it the first rate is free."""
        hold_position(self._flight, dt)


def flight_from(name: str, rig: Rig, near: Array | None, attitude: Array) -> Flight:
    """A flight at the exact pose for the attitude (3, 3) nearest to `near` (4,) [rad], or to home where None.

    Raises `MethodError` where the rig has no fourth axis, or has jerk limits.
    """
    require_fourth_axis(name, rig)
    require_no_jerk_limits(name, rig)
    pose, code = start_pose(rig, attitude, near)
    return new_flight(rig, pose, code, attitude)
