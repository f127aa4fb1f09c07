"""What the planner can be told."""

import math
from dataclasses import dataclass

DEG = math.pi / 180.0


@dataclass(frozen=True)
class PlanOptions:
    """Grid, cost and refinement of a plan; the defaults are the measured ones (docs/decisions/0005-planner.md)."""

    grid: float = 1.0 * DEG  # [rad] spacing of the nodes on the self-motion curve
    stage: float = 0.05  # [s] between the stages of the dynamic programme
    knot: float = 0.025  # [s] between the knots of the refinement's spline
    fine_grid: float = 0.25 * DEG  # [rad] of the grid that a verdict of "infeasible" rests on
    singularity_margin: float = 0.05  # sin^2 d2 + cos^2 d3 below which the cost rises
    singularity_cost: float = 4.0  # [1/s] at the singularity itself, beside rates squared as shares of their limits
    acceleration_cost: float = 0.5  # accelerations squared as shares of their limits, beside rates
    home_cost: float = 1e-3  # (angle - home)^2 [1/rad^2/s]: decides where nothing else does
    reserve: float = 1e-3  # share of a limit that the refinement leaves unused, for what falls between its rows
    trust: float = 20.0 * DEG  # [rad] the farthest one iteration moves along the self-motion
    iterations: int = 12  # of the refinement, at most
    alternatives: int = 9  # other chains tried before the accelerations are called the obstacle
    window: float = 12.0  # [s] of one refinement problem; longer flights go window by window
    best_effort: bool = True  # an infeasible flight is brought inside the limits, at the least attitude error
    overlap: float = 3.0  # [s] that a window shares with the one before
