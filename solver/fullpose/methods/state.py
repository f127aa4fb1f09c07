"""The record of a flight in progress: what a step method knows of its rig, its last samples and its next.

One record a flight, held by its stepper, so that a kernel takes one argument and makes no arrays.
"""

from typing import Protocol

import numpy as np

from fullpose._jit import inlined
from fullpose._typing import Array, Codes, Integers
from fullpose.limits import WEIGHT, Box, limit_box, limit_table, tolerances
from fullpose.rig import Rig

FRESH, PLACED, MOVING = range(3)  # no sample yet; a pose but no rate; both


class Flight(Protocol):
    """A flight in progress, as `FLIGHT` lays it out."""

    # The rig
    horizontal: bool
    axes: Integers  # (4,)
    limits: Array  # (6, 4), `limits.limit_table`
    weight: Array  # (4,) of the frames in the step: the rig's, or what the method makes of them
    # What is wanted of the null space, and of the way back to the attitude: `limited.Gains`
    avoidance: float
    centring: float
    homing: float
    recovery: float
    # The last sample
    phase: int
    code: int  # `limited_code`
    clock: float  # [s]
    past: float  # [s] the interval before it
    pose: Array  # (4,) [rad]
    rate: Array  # (4,) [rad/s] over the interval before it
    target: Array  # (3, 3) the attitude that was asked for
    # The next sample, while it is found
    ahead: float  # [s] the interval to it
    on_target: bool  # whether `goal` is the attitude asked for, not a place on the way back to it
    goal: Array  # (3, 3) the attitude to go for
    lo: Array  # (4,) [rad] the box of poses
    hi: Array
    lo_code: Codes  # (4,) `limited_code` of the limit that set the bound
    hi_code: Codes
    tolerance: Array  # (4,) [rad] how far outside the box a frame may round
    increment: Array  # (4,) [rad] null-space increment
    guess: Array  # (4,) [rad] what the linearised programme proposes
    next: Array  # (4,) [rad] the sample
    # Room to work in
    F: Array  # (3, 3) attitude of a pose
    J: Array  # (3, 4) its Jacobian
    null: Array  # (4,) its null vector
    e: Array  # (3,) [rad] increment of attitude
    step: Array  # (4,) [rad]
    damping: Array  # (4,)
    system: Array  # (4, 5) a linear system


FLIGHT = np.dtype(
    (
        np.record,
        np.dtype(
            [
                ("horizontal", "?"), ("axes", "i8", 4), ("limits", "f8", (6, 4)), ("weight", "f8", 4),
                ("avoidance", "f8"), ("centring", "f8"), ("homing", "f8"), ("recovery", "f8"),
                ("phase", "i8"), ("code", "i8"), ("clock", "f8"), ("past", "f8"),
                ("pose", "f8", 4), ("rate", "f8", 4), ("target", "f8", (3, 3)),
                ("ahead", "f8"), ("on_target", "?"), ("goal", "f8", (3, 3)),
                ("lo", "f8", 4), ("hi", "f8", 4), ("lo_code", "i2", 4), ("hi_code", "i2", 4), ("tolerance", "f8", 4),
                ("increment", "f8", 4), ("guess", "f8", 4), ("next", "f8", 4),
                ("F", "f8", (3, 3)), ("J", "f8", (3, 4)), ("null", "f8", 4), ("e", "f8", 3),
                ("step", "f8", 4), ("damping", "f8", 4), ("system", "f8", (4, 5)),
            ],
            align=True,
        ),
    )
)  # fmt: skip


def new_flight(rig: Rig, pose: Array, code: int, attitude: Array) -> Flight:
    """A flight that starts at `pose` (4,) [rad], marked `code`, for the attitude (3, 3); all gains are zero."""
    flight: Flight = np.zeros(1, FLIGHT)[0]
    flight.horizontal = rig.geometry.horizontal
    flight.axes[:] = rig.axes
    flight.limits[:] = limit_table(rig)
    flight.weight[:] = flight.limits[WEIGHT]
    flight.phase = FRESH
    flight.code = code
    flight.pose[:] = pose
    flight.target[:] = attitude
    return flight


def hold_position(flight: Flight, dt: float) -> None:
    """The flight stands at its pose since `dt` [s] before time 0: the rate of its first sample is no longer free."""
    flight.rate[:] = 0.0
    flight.past = dt
    flight.clock = 0.0
    flight.phase = MOVING


@inlined
def box_ahead(flight: Flight) -> None:
    """lo, hi, their codes, tolerance <- the box of the next sample."""
    past = flight.past if flight.phase == MOVING else 0.0
    box = Box(flight.lo, flight.hi, flight.lo_code, flight.hi_code)
    limit_box(flight.limits, flight.pose, flight.rate, past, flight.ahead, box)
    tolerances(flight.limits, past, flight.ahead, flight.tolerance)


@inlined
def advance(flight: Flight, time: float, code: int, C: Array) -> None:
    """The sample `next` at `time` [s] is the last one from now on; `code` is its mark, C (3, 3) its target."""
    h = time - flight.clock
    if flight.phase != FRESH:
        for i in range(4):
            flight.rate[i] = (flight.next[i] - flight.pose[i]) / h
        flight.past = h
        flight.phase = MOVING
    else:
        flight.phase = PLACED
    for i in range(4):
        flight.pose[i] = flight.next[i]
    flight.clock = time
    flight.code = code
    for i in range(3):
        for j in range(3):
            flight.target[i, j] = C[i, j]
