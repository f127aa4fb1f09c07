"""`follow_up`: the base follows the nose, and turns 90 deg out of the way near the pole (METHODS, section 7).

Source: Zhao Junhu 2017. The rig is driven as a vertical three-axis one (base, outer, inner; middle at zero) whose base
is a follow-up axis. Where the outer angle nears +-90 deg, and that base angle would have to turn half round at once,
the base instead turns 90 deg out of the way, the inner frame turns back, and the middle frame carries the motion over
the pole. The other three frames are always solved exactly for the base angle there is (base chart), so the attitude
is held as long as the middle frame stays inside (-90, 90) deg. The follow-up servo is a critically damped second
order one with the base's rate and acceleration limits, or the options' where the rig has none; the paper's servo is
not at hand. The base keeps its rate and acceleration; for the other frames nothing is promised: no limits are claimed.
"""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from solver._jit import kernel
from solver.charts import base_chart, nearest
from solver.methods.base import StepMethod, Stepper
from solver.methods.sequence import (
    CLOCK,
    LAST_STEP,
    MEMORY,
    SequenceStepper,
    exact_start,
    first_sample,
    keep_sample,
    require,
    require_fourth_axis,
)
from solver.rig import Rig

Array = NDArray[np.float64]

# The method's memory in the state: the base's rate, whether it is out of the way, where to, and the last interval.
BASE_RATE, ASIDE, ASIDE_AT, PAST = MEMORY, MEMORY + 1, MEMORY + 2, MEMORY + 3
HALF_PI = 0.5 * math.pi


@dataclass(frozen=True)
class FollowUpOptions:
    """Where the base turns aside and back, as the outer angle's distance from +-90 deg [rad]; the servo."""

    aside_within: float = math.radians(15.0)
    back_beyond: float = math.radians(20.0)
    bandwidth: float = 10.0  # [rad/s]
    max_rate: float = math.radians(200.0)  # [rad/s]
    max_acceleration: float = math.radians(1000.0)  # [rad/s^2]

    def __post_init__(self) -> None:
        require("aside_within", self.aside_within, 0.0, HALF_PI)
        require("back_beyond", self.back_beyond, self.aside_within, HALF_PI)
        require("bandwidth", self.bandwidth, 0.0, 1e3, open_low=True)
        require("max_rate", self.max_rate, 0.0, math.inf, open_low=True)
        require("max_acceleration", self.max_acceleration, 0.0, math.inf, open_low=True)


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
    _axes: NDArray[np.int64],
    _weight: Array,
    parameters: Array,
    time: Array,
    attitude: Array,
    state: Array,
    angles: Array,
    iterations: NDArray[np.int32],
) -> None:
    """See `sequence.SequenceKernel`; parameters: aside, back, bandwidth, rate, acceleration, base min, base max."""
    bandwidth, max_rate, max_acceleration = parameters[2], parameters[3], parameters[4]
    p = np.empty(4)
    for k in range(time.shape[0]):
        C = attitude[k]
        x = angles[k]
        if first_sample(time[k], C, state, x):
            continue
        h = time[k] - state[CLOCK]
        gap = base_target(horizontal, C, state[0], parameters, state) - state[0]
        # Critically damped, and never faster than it can brake within the gap.
        wanted = math.copysign(min(0.5 * bandwidth * abs(gap), math.sqrt(max_acceleration * abs(gap)), max_rate), gap)
        change = max_acceleration * 0.5 * (h + (state[PAST] if state[PAST] > 0.0 else h))
        state[PAST] = h
        rate = state[BASE_RATE] + min(max(2.0 * bandwidth * h * (wanted - state[BASE_RATE]), -change), change)
        state[BASE_RATE] = rate
        base = min(max(state[0] + rate * h, parameters[5]), parameters[6])
        base_chart(horizontal, C, base, 1.0 if math.cos(state[2]) >= 0.0 else -1.0, p)
        x[0] = base
        for i in range(1, 4):
            x[i] = nearest(p[i], state[i] + state[LAST_STEP + i])
        iterations[k] = 1
        keep_sample(time[k], C, x, state)


def _stepper(rig: Rig, options: FollowUpOptions, start: Array | None, attitude: Array) -> Stepper:
    require_fourth_axis("follow_up", rig)
    base = rig.frames[0]
    parameters = [
        options.aside_within,
        options.back_beyond,
        options.bandwidth,
        min(options.max_rate, base.max_rate),
        min(options.max_acceleration, base.max_acceleration),
        base.min,
        base.max,
    ]
    return SequenceStepper(rig, follow_up_block, parameters, exact_start(rig, attitude, start))


METHOD = StepMethod(
    name="follow_up",
    source="Zhao Junhu 2017, the base as a follow-up axis that turns out of the way",
    claims_limits=False,
    options=FollowUpOptions,
    stepper=_stepper,
)
