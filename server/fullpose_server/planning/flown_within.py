"""A flight as it is solved: as it was given, or within a tolerance; and what a report says of that."""

from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from fullpose._typing import Array
from fullpose.attitude import dcm_from_quaternion
from fullpose.compare import EXACT_WITHIN
from fullpose.recorded import Smoothed, smooth
from fullpose.solution import Solution
from fullpose.verify import attitude_errors, payload_attitudes
from fullpose_server.formats.tolerance_report import judged, tolerance_radians, tolerance_report, without_tolerance


@dataclass(frozen=True)
class Within:
    """time (n,) [s], q (n, 4) reference to body, as they are solved, beside the quaternions that were given.

    smoothed: what was taken away; tolerance_deg: within what. A remedy may take noise away that nobody gave a tolerance
    for.
    """

    given_time: Array  # (n,) [s]
    given_q: Array  # (n, 4)
    time: Array
    q: Array
    tolerance_deg: float | None = None
    smoothed: Smoothed | None = None

    @property
    def attitude(self) -> Array:
        """(n, 3, 3) body from reference, as it is solved."""
        return dcm_from_quaternion(self.q)

    def keys(self) -> dict[str, Any]:
        """What a report says of the tolerance; nothing without one."""
        if self.smoothed is None or self.tolerance_deg is None:
            return {}
        return tolerance_report(self.smoothed, self.tolerance_deg)

    def reported(self, report: dict[str, Any]) -> dict[str, Any]:
        """A report whose errors are to the flight that was given, with what it says of the tolerance."""
        told = self.keys()
        return judged(report | told) if told else report | without_tolerance(self.given_time, self.given_q, report)

    def reported_on_top(self, report: dict[str, Any]) -> dict[str, Any]:
        """The same of a report whose errors are to what was solved: the deviation and the method's own error add up."""
        told = self.keys()
        if not told:
            return self.reported(report)
        own, deviation = report["max_error_deg"], told["deviation_deg"]["max"]
        if own is not None:
            own = deviation if np.radians(own) < EXACT_WITHIN else own + deviation
        return self.reported(report | {"max_error_deg": own})

    def measured(self, solution: Solution) -> Solution:
        """The solution, sample by sample, with its errors to the flight that was given."""
        if self.smoothed is None:
            return solution
        given = dcm_from_quaternion(self.given_q)
        error, matrix_error = attitude_errors(payload_attitudes(solution.rig, solution.angles), given)
        return replace(solution, error=error, matrix_error=matrix_error)


def flown_within(time: Array, q: Array, tolerance_deg: float | None, name: str = "tolerance_deg") -> Within:
    """The flight of time (n,) [s], q (n, 4) within a tolerance, as it is for None; `name` is what that is called.

    Raises `InputError` for a tolerance that is none.
    """
    if tolerance_deg is None:
        return Within(time, q, time, q)
    radians = tolerance_radians(tolerance_deg, name)
    return behind(time, q, smooth(time, dcm_from_quaternion(q), radians), tolerance_deg)


def behind(time: Array, q: Array, smoothed: Smoothed, tolerance_deg: float | None = None) -> Within:
    """The flight that was found behind time (n,) [s], q (n, 4)."""
    return Within(time, q, np.array(smoothed.time), np.array(smoothed.q), tolerance_deg, smoothed)
