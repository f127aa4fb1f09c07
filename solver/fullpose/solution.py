"""What a method returns: angles, errors, what was limited, iterations, timings."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fullpose._typing import Codes, Counts
from fullpose.rig import FRAMES, LIMITS, Rig

EXACT = 0


def limited_code(frame: int, limit: int) -> int:
    """The mark of a sample that `limit` of `frame` kept from the attitude: 1..12; 0 is `EXACT`."""
    return 1 + 3 * frame + limit


def limited_name(code: int) -> tuple[str, str] | None:
    """(frame, limit) of a mark, as in `FRAMES` and `LIMITS`; None where the sample was not limited."""
    if code == EXACT:
        return None
    return FRAMES[(code - 1) // 3], LIMITS[(code - 1) % 3]


@dataclass(frozen=True)
class Blocking:
    """What closed the way of an infeasible flight: when [s], which frame, which limit."""

    time: float
    frame: str
    limit: str


@dataclass(frozen=True)
class Solution:
    """Frame angles for a flight. Arrays are read-only, one row a sample."""

    method: str
    rig: Rig
    time: NDArray[np.float64]  # (n,) [s]
    angles: NDArray[np.float64]  # (n, 4) [rad], base first, unwrapped
    error: NDArray[np.float64]  # (n,) [rad] geodesic
    matrix_error: NDArray[np.float64]  # (n,) largest entry of F - C
    limited: Codes  # (n,) `limited_code`
    iterations: Counts  # (n,)
    step_time: NDArray[np.float64]  # (n,) [s] mean of the sample's block; nan where no clock was given
    solve_time: float  # [s]; nan where no clock was given
    blocking: Blocking | None = None

    def __post_init__(self) -> None:
        for name in ("time", "angles", "error", "matrix_error", "limited", "iterations", "step_time"):
            getattr(self, name).setflags(write=False)

    @property
    def limited_samples(self) -> int:
        """How many samples could not hold the attitude inside the limits."""
        return int(np.count_nonzero(self.limited))
