"""What is optimised: the attitude over time that a rig is to fly, and how."""

from dataclasses import dataclass, field, replace

from fullpose._typing import Array
from fullpose.rig import Rig
from fullpose.trajectory.interior_point import solve_by_piqp
from fullpose.trajectory.options import PlanOptions
from fullpose.trajectory.qp import Solver


@dataclass(frozen=True)
class Problem:
    """An attitude over time for a rig, what is fixed at its first sample, and the means to solve it."""

    time: Array  # (n,) [s]
    attitude: Array  # (n, 3, 3) body from reference
    rig: Rig
    options: PlanOptions = field(default_factory=PlanOptions)
    start: Array | None = None  # (4,) [rad] the first pose, exact
    start_rate: Array | None = None  # (4,) [rad/s] of the frames over the first interval, as far as it is free
    solver: Solver = solve_by_piqp

    def __len__(self) -> int:
        return len(self.time)

    def part(self, begin: int, end: int) -> "Problem":
        """Samples begin..end (half-open); the start belongs to the first of all only."""
        part = slice(begin, end)
        inner = replace(self, time=self.time[part], attitude=self.attitude[part])
        return inner if begin == 0 else replace(inner, start=None, start_rate=None)
