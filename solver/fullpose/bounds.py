"""Which bound of which frame: the one coding of it, for kernels, records of samples, programmes, verdicts and files.

Kernels take a frame and a limit as the indices of `FRAMES` and `LIMITS`, and a side. A limit of a frame has a code,
1..16, which is what a sample is marked with that the limit kept from the attitude; 0 marks a sample that none did.
Position, rate and acceleration of the base come first, then those of the next frame; the jerks, which came later, last:
records of before stay readable.
"""

from typing import NamedTuple

import numpy as np

from fullpose._typing import Integers
from fullpose.rig import FRAMES, LIMITS, Frame, Limit

POSITION, RATE, ACCELERATION, JERK = (LIMITS.index(limit) for limit in Limit)
EXACT = 0  # the code of a sample that no limit kept from the attitude
CODES_PER_FRAME = 3  # one after the other: without the jerk's
_FIRST_JERK = 1 + CODES_PER_FRAME * len(FRAMES)
LOWER, UPPER = range(2)  # sides
MET = 1e-7  # of a limit: over it by less counts as inside, in the planner

# What the check of a path and the guard of a rig let pass: rounding, and the touch of a path that stands on the end of
# a range, which an iteration meets to the square root of its own precision.
POSITION_TOLERANCE = 2e-9  # [rad] 0.0004 arc seconds: what `MET` is of the planner's unit of positions
TOLERANCE = 1e-6  # of a rate, acceleration or jerk limit
# of a position, as its third difference sees it
JERK_ROUNDING = 16.0 * 2.22e-16


class Bound(NamedTuple):
    """Sides of limits of frames, as indices: (r,) each. The order is that of the columns where they are one array."""

    frame: Integers
    limit: Integers
    side: Integers


def limited_code(frame: int, limit: int) -> int:
    """The mark of a sample that `limit` of `frame` kept from the attitude: 1..16; 0 is `EXACT`."""
    if limit == JERK:
        return _FIRST_JERK + frame
    return 1 + CODES_PER_FRAME * frame + limit


def limited_name(code: int) -> tuple[Frame, Limit] | None:
    """(frame, limit) of a mark; None where the sample was not limited."""
    if code == EXACT:
        return None
    if code >= _FIRST_JERK:
        return FRAMES[code - _FIRST_JERK], Limit.JERK
    return FRAMES[(code - 1) // CODES_PER_FRAME], LIMITS[(code - 1) % CODES_PER_FRAME]


# Of every limit, frame by frame and by the order of the derivative: as arrays (..., 4, 4) of limits are laid out. (16,)
CODES = np.array([limited_code(i, k) for i in range(len(FRAMES)) for k in range(len(LIMITS))], np.int16)
CODES.setflags(write=False)
