"""What smoothing leaves of a tolerance is the planner's: where a limit closes the exact way, it may miss by that."""

from dataclasses import replace
from typing import Any

from fullpose.recorded import Smoothed
from fullpose.registry import find_method
from fullpose.trajectory.options import PlanOptions


def with_remaining(method: str, options: Any, smoothed: Smoothed | None) -> Any:
    """The options of a method, with the rest of the tolerance where it knows what to do with one and was given none."""
    if smoothed is None or smoothed.tolerance is None or find_method(method).options is not PlanOptions:
        return options
    chosen = options or PlanOptions()
    left = smoothed.tolerance - smoothed.max_deviation
    return replace(chosen, tolerance=left) if left > 0.0 and chosen.tolerance == 0.0 else chosen
