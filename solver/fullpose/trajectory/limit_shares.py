"""What a path of all frames leaves of each limit, sample by sample, as a share of it."""

import numpy as np

from fullpose._typing import Array
from fullpose.bounds import ACCELERATION, JERK, POSITION, RATE
from fullpose.rig import LIMITS, Rig
from fullpose.verify import differences, jerks


def limit_shares(time: Array, angles: Array, rig: Rig, position_unit: Array | float) -> Array:
    """What angles (n, 4) [rad] at time (n,) [s] leave of each limit: (n, 4, 4), negative beyond it.

    Of a range the distance to its nearer end over `position_unit` [rad]; of a rate limit the lesser of the intervals
    on either side; of an acceleration limit at the samples but the first and last, of a jerk limit but the first two
    and the last. inf where there is no limit, or no difference shows it.
    """
    left = np.full((len(time), 4, len(LIMITS)), np.inf)
    left[:, :, POSITION] = np.minimum(rig.position_max - angles, angles - rig.position_min) / position_unit
    if len(time) > 1:
        rate, acceleration = differences(time, angles)
        spare = 1.0 - np.abs(rate) / rig.max_rate
        left[1:, :, RATE] = spare
        left[:-1, :, RATE] = np.minimum(left[:-1, :, RATE], spare)
        left[1:-1, :, ACCELERATION] = 1.0 - np.abs(acceleration) / rig.max_acceleration
        if rig.jerk_limited and len(time) > 3:
            left[2:-1, :, JERK] = 1.0 - np.abs(jerks(time, acceleration)) / rig.max_jerk
    return left
