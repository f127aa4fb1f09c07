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

import numpy as np

from fullpose._jit import kernel
from fullpose._typing import Array, Counts, Integers
from fullpose.bounds import EXACT
from fullpose.charts import base_chart, nearest
from fullpose.errors import MethodError
from fullpose.limits import ACCELERATION, RATE, approach_rate, limit_box, limit_table
from fullpose.methods.base import StepMethod, Stepper
from fullpose.methods.start_pose import start_pose
from fullpose.methods.unlimited import (
    CLOCK,
    MEMORY,
    SequenceStepper,
    first_sample,
    keep_sample,
    open_rig,
    require_fourth_axis,
)
from fullpose.options import Options, ranged
from fullpose.rig import Rig

# The method's memory in the state: the base's rate, whether it is out of the way, where to, and the last interval.
BASE_RATE, ASIDE, ASIDE_AT, PAST = MEMORY, MEMORY + 1, MEMORY + 2, MEMORY + 3
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


@kernel
def base_target(horizontal: bool, C: Array, base: float, parameters: Array, state: Array) -> float:
    """Where the base should be [rad] for the attitude C; keeps the method's memory."""
    # The nose in the vertical rig's reference axes: along x, and along z, the plane that the base turns in.
    along = C[0, 0]
    across = -C[0, 1] if horizontal else C[0, 2]
    level = math.hypot(along, across)
    if state[ASIDE] == 0.0 and level < math.sin(parameters[0]):
        state[ASIDE] = 1.0
        state[ASIDE_AT] = base + HALF_PI
    elif state[ASIDE] != 0.0 and level > math.sin(parameters[1]):
        state[ASIDE] = 0.0
    if state[ASIDE] != 0.0:
        return float(state[ASIDE_AT])
    # Middle at zero with the outer angle on this side of the pole or on the other: the base angles half a turn apart.
    ahead = nearest(math.atan2(-across, along), base)
    behind = nearest(math.atan2(across, -along), base)
    return float(ahead if abs(ahead - base) <= abs(behind - base) else behind)


@kernel
def follow_up_block(
    horizontal: bool,
    _axes: Integers,
    _weight: Array,
    parameters: Array,
    time: Array,
    attitude: Array,
    state: Array,
    angles: Array,
    iterations: Counts,
) -> None:
    """See `sequence.SequenceKernel`; parameters: aside, back, bandwidth, then a `limit_table`, row by row."""
    bandwidth = parameters[2]
    table = parameters[3:].reshape(-1, 4)
    p = np.empty(4)
    v = np.zeros(4)  # the base's alone is known, and asked for
    lo = np.empty(4)
    hi = np.empty(4)
    lo_code = np.empty(4, np.int16)
    hi_code = np.empty(4, np.int16)
    for k in range(time.shape[0]):
        C = attitude[k]
        x = angles[k]
        if first_sample(time[k], C, state, x):
            continue
        h = time[k] - state[CLOCK]
        past = state[PAST] if state[PAST] > 0.0 else h  # the base stood at the start
        v[0] = state[BASE_RATE]
        limit_box(table, state[0:4], v, past, h, lo, hi, lo_code, hi_code)
        gap = base_target(horizontal, C, state[0], parameters, state) - state[0]
        # Critically damped, and never faster than half its deceleration can brake within the gap. A step longer than
        # the servo's own time takes on the wanted rate at once: more of it would overshoot, and swing ever wider.
        wanted = min(0.5 * bandwidth * abs(gap), approach_rate(abs(gap), 0.5 * table[ACCELERATION, 0], h))
        rate = v[0] + min(2.0 * bandwidth * h, 1.0) * (math.copysign(wanted, gap) - v[0])
        base = min(max(state[0] + rate * h, lo[0]), hi[0])
        state[BASE_RATE] = (base - state[0]) / h
        state[PAST] = h
        base_chart(horizontal, C, base, 1.0 if math.cos(state[2]) >= 0.0 else -1.0, p)
        x[0] = base
        for i in range(1, 4):
            # Nearest to the last angle, not to where its last step would lead: that may be a half turn (see above).
            x[i] = nearest(p[i], state[i])
        iterations[k] = 1
        keep_sample(time[k], C, x, state)


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
    table = limit_table(rig)
    table[RATE, 0] = min(table[RATE, 0], options.max_rate)
    table[ACCELERATION, 0] = min(table[ACCELERATION, 0], options.max_acceleration)
    parameters = [options.aside_within, options.back_beyond, options.bandwidth, *table.ravel().tolist()]
    return SequenceStepper(rig, follow_up_block, parameters, _start(rig, attitude, start))


METHOD = StepMethod(
    name="follow_up",
    source="Zhao Junhu 2017, the base as a follow-up axis that turns out of the way",
    claims_limits=False,
    options=FollowUpOptions,
    stepper=_stepper,
)
