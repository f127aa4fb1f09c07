"""The dynamics of a simulated table: four second-order servos with saturation. One kernel; radians."""

import math

from fullpose._jit import kernel
from fullpose._typing import Array

DISABLED, ENABLED, BRAKING = 0, 1, 2
SUBSTEPS = 2
# Rows of the state: motor position and rate, load position (behind the backlash).
MOTOR, RATE, LOAD = 0, 1, 2
# Rows of the parameters.
OMEGA, DAMPING, MAX_RATE, MAX_ACCELERATION, BACKLASH, FEED_FORWARD, PRESENT = 0, 1, 2, 3, 4, 5, 6
# Rows of the disturbances: 1 where the frame is stuck, or runs away.
STUCK, RUNAWAY = 0, 1


@kernel
def advance(
    ticks: int,
    dt: float,
    state: Array,
    parameters: Array,
    disturbed: Array,
    was: Array,
    demand: Array,
    mode: int,
    quiet: int,
    watchdog: int,
) -> int:
    """Advance the servos by `ticks` of `dt` [s]; returns the mode afterwards.

    state (3, 4), parameters (7, 4) and disturbed (2, 4) as the row names say; demand (3, 4) is position, rate and
    acceleration due at the end of the first tick, was (4,) the position due at its start. `quiet` ticks have passed
    since the last write: beyond `watchdog` the servos brake by themselves.
    """
    h = dt / SUBSTEPS
    for tick in range(ticks):
        if mode == ENABLED and quiet + tick > watchdog:
            mode = BRAKING
        for sub in range(SUBSTEPS):
            # The reference now, not at the substep's end: the servo would lead by half a tick.
            share = float(sub) / SUBSTEPS if tick == 0 else 1.0
            for i in range(4):
                if parameters[PRESENT, i] == 0.0:
                    continue
                v = state[RATE, i]
                most = parameters[MAX_ACCELERATION, i]
                if disturbed[RUNAWAY, i] != 0.0:
                    a = most
                elif mode == ENABLED:
                    w = parameters[OMEGA, i]
                    reference = was[i] + share * (demand[0, i] - was[i])
                    a = (
                        w * w * (reference - state[MOTOR, i])
                        + 2.0 * parameters[DAMPING, i] * w * (demand[1, i] - v)
                        + parameters[FEED_FORWARD, i] * demand[2, i]
                    )
                    a = min(max(a, -most), most)
                else:
                    a = -math.copysign(min(most, abs(v) / h), v)
                v += a * h
                if abs(v) > parameters[MAX_RATE, i]:
                    v = math.copysign(parameters[MAX_RATE, i], v)
                if disturbed[STUCK, i] != 0.0:
                    v = 0.0
                state[RATE, i] = v
                state[MOTOR, i] += v * h
                # Backlash: the load moves only while the motor pushes it.
                half = 0.5 * parameters[BACKLASH, i]
                gap = state[MOTOR, i] - state[LOAD, i]
                if gap > half:
                    state[LOAD, i] = state[MOTOR, i] - half
                elif gap < -half:
                    state[LOAD, i] = state[MOTOR, i] + half
    return mode
