"""What a method returns: angles, errors, what was limited, iterations, timings."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fullpose._typing import Codes, Counts
from fullpose.rig import Frame, Limit, Rig


@dataclass(frozen=True)
class Blocking:
    """What closed the way of an infeasible flight: when [s], which frame, which limit."""

    time: float
    frame: Frame
    limit: Limit


@dataclass(frozen=True)
class Solution:
    """Frame angles for a flight. Arrays are read-only, one row a sample."""

    method: str
    rig: Rig
    time: NDArray[np.float64]  # (n,) [s]
    angles: NDArray[np.float64]  # (n, 4) [rad], base first, unwrapped
    error: NDArray[np.float64]  # (n,) [rad] geodesic
    matrix_error: NDArray[np.float64]  # (n,) largest entry of F - C
    limited: Codes  # (n,) `bounds.limited_code`
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
