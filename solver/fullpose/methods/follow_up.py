"""`follow_up`: the base follows the nose, and turns 90 deg out of the way near the pole (mathematics, section 7).

Source: Zhao Junhu 2017. The rig is driven as a vertical three-axis one (base, outer, inner; middle at zero) whose base
is a follow-up axis. Where the outer angle nears +-90 deg, and that base angle would have to turn half round at once,
the base instead turns 90 deg out of the way, the inner frame turns back, and the middle frame carries the motion over
the pole. The other three frames are always solved exactly for the base angle there is (base chart), so the attitude
is held whatever the base does; where a base too slow, or on its stop, lets the middle frame come to +-90 deg, the outer
and inner ones turn half round at once. The follow-up servo is a critically damped second order one inside
`fullpose.limits.limit_box` of the base: its position, rate and acceleration limits, the last two no higher than the
options'. The paper's servo is not at hand. For the other frames nothing is promised: no limits are claimed.
"""

import math
from dataclasses import dataclass, replace
from typing import Any, Protocol

from fullpose._jit import inner
from fullpose._typing import Array
from fullpose.bounds import EXACT
from fullpose.charts import base_chart, nearest
from fullpose.errors import MethodError
from fullpose.limits import ACCELERATION, RATE, Box, approach_rate, limit_box
from fullpose.methods.base import StepMethod, Stepper
from fullpose.methods.block import BlockStepper, block_kernel, record_of
from fullpose.methods.start_pose import require_fourth_axis, start_pose
from fullpose.methods.state import MOVING, Flight, new_flight
from fullpose.methods.unlimited import open_rig
from fullpose.options import Options, ranged
from fullpose.rig import Rig

HALF_PI = 0.5 * math.pi


@dataclass(frozen=True)
class FollowUpOptions(Options):
    """Where the base turns aside and back, as the outer angle's distance from +-90 deg [rad]; the servo."""

    aside_within: float = ranged(math.radians(15.0), 0.0, HALF_PI)
    back_beyond: float = ranged(math.radians(20.0), 0.0, HALF_PI)
    bandwidth: float = ranged(10.0, 0.0, 1e3, open=True)  # [rad/s]
    max_rate: float = ranged(math.radians(200.0), 0.0, open=True)  # [rad/s]
    max_acceleration: float = ranged(math.radians(1000.0), 0.0, open=True)  # [rad/s^2]

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.back_beyond < self.aside_within:
            expected = f"at least aside_within, {self.aside_within:g}"
            raise MethodError(f"option back_beyond = {self.back_beyond!r}: expected {expected}")


class FollowUp(Protocol):
    """The options, and what the method keeps for itself, as `_stepper` lays them out."""

    aside_within: float
    back_beyond: float
    bandwidth: float
    aside: bool  # whether the base is out of the way
    aside_at: float  # [rad] where to


@inner
def base_target(flight: Flight, own: FollowUp, C: Array) -> float:
    """Where the base should be [rad] for the attitude C; keeps the method's memory."""
    base = flight.pose[0]
    # The nose in the vertical rig's reference axes: along x, and along z, the plane that the base turns in.
    along = C[0, 0]
    across = -C[0, 1] if flight.horizontal else C[0, 2]
    level = math.hypot(along, across)
    if not own.aside and level < math.sin(own.aside_within):
        own.aside = True
        own.aside_at = base + HALF_PI
    elif own.aside and level > math.sin(own.back_beyond):
        own.aside = False
    if own.aside:
        return float(own.aside_at)
    # Middle at zero with the outer angle on this side of the pole or on the other: the base angles half a turn apart.
    ahead = nearest(math.atan2(-across, along), base)
    behind = nearest(math.atan2(across, -along), base)
    return float(ahead if abs(ahead - base) <= abs(behind - base) else behind)


@inner
def follow_up_step(flight: Flight, parameters: Any, C: Array) -> tuple[int, int]:
    """See `block.propose`; parameters: (1,) `FollowUp`."""
    own: FollowUp = parameters[0]
    h = flight.ahead
    past = flight.past if flight.phase == MOVING else h  # the base stood at the start
    box = Box(flight.lo, flight.hi, flight.lo_code, flight.hi_code)
    limit_box(flight.limits, flight.pose, flight.rate, past, h, box)  # the base's alone is asked for
    gap = base_target(flight, own, C) - flight.pose[0]
    # Critically damped, and never faster than half its deceleration can brake within the gap. A step longer than
    # the servo's own time takes on the wanted rate at once: more of it would overshoot, and swing ever wider.
    braking = approach_rate(abs(gap), 0.5 * flight.limits[ACCELERATION, 0], h)
    wanted = min(0.5 * own.bandwidth * abs(gap), braking)
    rate = flight.rate[0] + min(2.0 * own.bandwidth * h, 1.0) * (math.copysign(wanted, gap) - flight.rate[0])
    x = flight.next
    x[0] = min(max(flight.pose[0] + rate * h, flight.lo[0]), flight.hi[0])
    branch = 1.0 if math.cos(flight.pose[2]) >= 0.0 else -1.0
    base_chart(flight.horizontal, C, x[0], branch, flight.guess)
    for i in range(1, 4):
        # Nearest to the last angle, not to where its last step would lead: that may be a half turn (see above).
        x[i] = nearest(flight.guess[i], flight.pose[i])
    return 1, EXACT


follow_up_block = block_kernel("follow_up_block", follow_up_step)


def _start(rig: Rig, attitude: Array, near: Array | None) -> Array:
    """The exact pose (4,) [rad] nearest to `near` (or home): inside all position limits if there is one, else the base.

    Every base angle has an exact pose.
    """
    pose, code = start_pose(rig, attitude, near)
    if code == EXACT:
        return pose
    _, outer, middle, inner = open_rig(rig).frames
    return start_pose(replace(rig, frames=(rig.frames[0], outer, middle, inner)), attitude, near)[0]


def _stepper(rig: Rig, options: FollowUpOptions, start: Array | None, attitude: Array) -> Stepper:
    require_fourth_axis("follow_up", rig)
    flight = new_flight(rig, _start(rig, attitude, start), EXACT, attitude)
    flight.limits[RATE, 0] = min(flight.limits[RATE, 0], options.max_rate)
    flight.limits[ACCELERATION, 0] = min(flight.limits[ACCELERATION, 0], options.max_acceleration)
    return BlockStepper(follow_up_block, record_of(options, (("aside", "?"), ("aside_at", "f8"))), flight)


METHOD = StepMethod(
    name="follow_up",
    source="Zhao Junhu 2017, the base as a follow-up axis that turns out of the way",
    claims_limits=False,
    options=FollowUpOptions,
    stepper=_stepper,
)
