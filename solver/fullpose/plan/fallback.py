"""Paths that are taken sample by sample: inside every limit but those of jerk, exact wherever that could be had."""

from dataclasses import dataclass
from functools import cached_property

from fullpose._typing import Array
from fullpose.methods import METHODS
from fullpose.preview.flight import PreviewFlight
from fullpose.preview.options import PreviewOptions
from fullpose.rig import without_jerk_limits
from fullpose.trajectory.problem import Problem

# [s] known and [s] between two trajectories, of the previews
FORESIGHTS = ((4.0, 0.2), (8.0, 0.5))
EXACT_ERROR = 1e-12  # [rad] of attitude error above which a sample is not exact
FORESEEN = 600.0  # [s] of a flight that they are tried for: they take a tenth of its length


@dataclass(frozen=True)
class Fallback:
    """Such paths of one problem on a four-axis rig, (n, 4) [rad] each: made when they are asked for, and kept.

    Nobody changes a path once it is made.
    """

    problem: Problem

    @cached_property
    def exact(self) -> Array:
        """By the step method `exact`."""
        p, method = self.problem, METHODS["exact"]
        return (
            method.stepper(without_jerk_limits(p.rig), method.options(), p.start, p.attitude[0])
            .block(p.time, p.attitude)
            .angles
        )

    @cached_property
    def foreseen(self) -> tuple[Array, ...]:
        """By `preview`, which may know much of the flight here; none of a flight that is too long for it."""
        p = self.problem
        if p.time[-1] - p.time[0] > FORESEEN:
            return ()
        every = (PreviewOptions(preview_s=known, replan_s=between) for known, between in FORESIGHTS)
        flights = (PreviewFlight(without_jerk_limits(p.rig), options, p.start, p.time, p.attitude) for options in every)
        return tuple(flight.block(p.time, p.attitude).angles for flight in flights)
