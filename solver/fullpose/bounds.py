"""Which bound of which frame: the one coding of it, for kernels, records of samples, programmes, verdicts and files.

Kernels take a frame and a limit as the indices of `FRAMES` and `LIMITS`. A limit of a frame has a code, 1..12, which is
what a sample is marked with that the limit kept from the attitude; 0 marks a sample that none did.
"""

from fullpose.rig import FRAMES, LIMITS, Frame, Limit

POSITION, RATE, ACCELERATION = (LIMITS.index(limit) for limit in Limit)
EXACT = 0  # the code of a sample that no limit kept from the attitude
CODES_PER_FRAME = len(LIMITS)


def limited_code(frame: int, limit: int) -> int:
    """The mark of a sample that `limit` of `frame` kept from the attitude: 1..12; 0 is `EXACT`."""
    return 1 + CODES_PER_FRAME * frame + limit


def limited_name(code: int) -> tuple[Frame, Limit] | None:
    """(frame, limit) of a mark; None where the sample was not limited."""
    if code == EXACT:
        return None
    return FRAMES[(code - 1) // CODES_PER_FRAME], LIMITS[(code - 1) % CODES_PER_FRAME]
