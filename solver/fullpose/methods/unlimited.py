"""What the methods that keep no limits share: where they start, the error of the last sample, the least-norm step.

Those that avoid a limit (`dwln`, `gradient_projection`) do not promise to keep it.
"""

import math
from dataclasses import replace

from fullpose._jit import inlined
from fullpose._typing import Array
from fullpose.bounds import EXACT
from fullpose.kinematics import jacobian, null_vector, payload_attitude, rotation_error
from fullpose.least_squares import least_norm, squared_damping
from fullpose.methods.start_pose import require_fourth_axis, start_pose
from fullpose.methods.state import Flight, new_flight
from fullpose.rig import Rig


@inlined
def increment_to(flight: Flight, C: Array) -> None:
    """e <- the increment from the attitude of the last sample to C (3, 3) [rad]: the loop is closed."""
    payload_attitude(flight.axes, flight.pose, flight.F)
    rotation_error(C, flight.F, flight.e)


@inlined
def least_norm_step(flight: Flight) -> None:
    """next <- the pose after the step that makes the increment e, in the flight's weights nearest to its increment.

    Next to the singularity, where J W^-1 J^T has no inverse, the inverse is damped, so that the step stays finite.
    """
    jacobian(flight.axes, flight.pose, flight.J)
    damping = squared_damping(null_vector(flight.J, flight.null))
    least_norm(flight.J, flight.weight, flight.increment, flight.e, damping, flight.next)
    for i in range(4):
        flight.next[i] += flight.pose[i]


def open_rig(rig: Rig) -> Rig:
    """The rig without position limits."""
    frames = tuple(replace(frame, min=-math.inf, max=math.inf) for frame in rig.frames)
    return replace(rig, frames=(frames[0], frames[1], frames[2], frames[3]))


def open_flight(name: str, rig: Rig, near: Array | None, attitude: Array) -> Flight:
    """A flight at the exact pose nearest to `near` (4,) [rad] (or home): inside the position limits if there is one.

    These methods do not know limits, so they rather start outside one than off the attitude (3, 3). Raises
    `MethodError` where the rig has no fourth axis.
    """
    require_fourth_axis(name, rig)
    pose, code = start_pose(rig, attitude, near)
    if code != EXACT:
        pose, _ = start_pose(open_rig(rig), attitude, near)
    return new_flight(rig, pose, EXACT, attitude)
