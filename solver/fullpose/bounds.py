"""Which bound of which frame: the one coding of it, for kernels, records of samples, programmes, verdicts and files.

Kernels take a frame and a limit as the indices of `FRAMES` and `LIMITS`, and a side. A limit of a frame has a code,
1..12, which is what a sample is marked with that the limit kept from the attitude; 0 marks a sample that none did.
"""

from typing import NamedTuple

from fullpose._typing import Integers
from fullpose.rig import FRAMES, LIMITS, Frame, Limit

POSITION, RATE, ACCELERATION = (LIMITS.index(limit) for limit in Limit)
EXACT = 0  # the code of a sample that no limit kept from the attitude
CODES_PER_FRAME = len(LIMITS)
LOWER, UPPER = range(2)  # sides
MET = 1e-7  # of a limit: over it by less counts as inside, in the planner

# What the check of a path and the guard of a rig let pass: rounding, and the touch of a path that stands on the end of
# a range, which an iteration meets to the square root of its own precision.
POSITION_TOLERANCE = 2e-9  # [rad] 0.0004 arc seconds: what `MET` is of the planner's unit of positions
TOLERANCE = 1e-6  # of a rate or acceleration limit


class Bound(NamedTuple):
    """Sides of limits of frames, as indices: (r,) each. The order is that of the columns where they are one array."""

    frame: Integers
    limit: Integers
    side: Integers


def limited_code(frame: int, limit: int) -> int:
    """The mark of a sample that `limit` of `frame` kept from the attitude: 1..12; 0 is `EXACT`."""
    return 1 + CODES_PER_FRAME * frame + limit


def limited_name(code: int) -> tuple[Frame, Limit] | None:
    """(frame, limit) of a mark; None where the sample was not limited."""
    if code == EXACT:
        return None
    return FRAMES[(code - 1) // CODES_PER_FRAME], LIMITS[(code - 1) % CODES_PER_FRAME]
