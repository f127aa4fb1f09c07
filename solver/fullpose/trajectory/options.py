"""What the planner can be told."""

import math
from dataclasses import dataclass

from fullpose.errors import MethodError
from fullpose.options import Options, ranged

DEG = math.pi / 180.0


@dataclass(frozen=True)
class PlanOptions(Options):
    """Grid, cost and refinement of a plan; the defaults are the measured ones (docs/decisions/0005-planner.md).

    Raises `MethodError` where a value is outside its range: a finer grid, stage or knot than its least asks for more
    memory than a machine has.
    """

    grid: float = ranged(1.0 * DEG, 0.02 * DEG, 30.0 * DEG)  # [rad] between nodes on the self-motion curve
    stage: float = ranged(0.05, 1e-3, 10.0)  # [s] between the stages of the dynamic programme
    knot: float = ranged(0.025, 1e-3, 10.0)  # [s] between the knots of the refinement's spline
    fine_grid: float = ranged(0.25 * DEG, 0.02 * DEG, 30.0 * DEG)  # [rad] that a verdict of "infeasible" rests on
    singularity_margin: float = ranged(0.05, 1e-6, 2.0)  # sin^2 d2 + cos^2 d3 below which the cost rises
    singularity_cost: float = ranged(4.0, 0.0, 1e6)  # [1/s] there, beside rates squared as shares of their limits
    acceleration_cost: float = ranged(0.5, 0.0, 1e6)  # accelerations squared as shares of their limits, beside rates
    home_cost: float = ranged(1e-3, 0.0, 1e6)  # (angle - home)^2 [1/rad^2/s]: decides where nothing else does
    reserve: float = ranged(1e-3, 0.0, 0.5)  # share of a limit that the refinement leaves for what lies between rows
    trust: float = ranged(20.0 * DEG, 0.01 * DEG, math.pi)  # [rad] the farthest one iteration moves
    iterations: int = ranged(12, 1, 1000)  # of the refinement, at most
    alternatives: int = ranged(9, 0, 100)  # other node paths tried before the accelerations are called the obstacle
    window: float = ranged(12.0, 0.1, 1e4)  # [s] of one refinement problem; longer flights go window by window
    best_effort: bool = True  # an infeasible flight is brought inside the limits, at the least tolerance
    tolerance: float = ranged(0.0, 0.0, math.pi)  # [rad] of attitude that may be missed where no exact path is found
    overlap: float = ranged(3.0, 0.0, 1e4)  # [s] that a window shares with the one before

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.overlap >= self.window:
            raise MethodError(f"option overlap = {self.overlap!r}: expected less than window, {self.window:g}")
