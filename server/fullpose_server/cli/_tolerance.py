"""A flight as a command flies it: as it was given, or within a tolerance."""

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

from fullpose_server.cli._flight import Flight
from fullpose_server.cli._progress import progress_bar

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fullpose.recorded import Smoothed
    from fullpose.solution import Solution


@dataclass(frozen=True)
class Within:
    """The flight that is solved, `flight` and `attitude` (n, 3, 3), beside the one that was given."""

    given: Flight
    given_attitude: "NDArray[Any]"
    flight: Flight
    attitude: "NDArray[Any]"
    tolerance_deg: float | None
    smoothed: "Smoothed | None"

    def reported(self, report: dict[str, Any]) -> dict[str, Any]:
        """The report with what it says of a tolerance. Its errors are to the flight that was given."""
        from fullpose_server.formats.tolerance_report import judged, tolerance_report, without_tolerance

        if self.smoothed is None or self.tolerance_deg is None:
            return report | without_tolerance(self.given.time, self.given.q, report)
        return judged(report | tolerance_report(self.smoothed, self.tolerance_deg))

    def measured(self, solution: "Solution") -> "Solution":
        """The solution with its errors to the flight that was given."""
        from fullpose.verify import attitude_errors, payload_attitudes

        if self.smoothed is None:
            return solution
        error, matrix_error = attitude_errors(payload_attitudes(solution.rig, solution.angles), self.given_attitude)
        return replace(solution, error=error, matrix_error=matrix_error)


def within(given: Flight, attitude: "NDArray[Any]", tolerance_deg: float | None) -> Within:
    """The flight within a tolerance [deg], as it is for None. Raises `InputError` for a tolerance that is none."""
    if tolerance_deg is None:
        return Within(given, attitude, given, attitude, None, None)
    from fullpose.recorded import smooth
    from fullpose_server.formats.tolerance_report import tolerance_radians

    with progress_bar("tolerance"):
        smoothed = smooth(given.time, attitude, tolerance_radians(tolerance_deg, "--tolerance"))
    flown = Flight(smoothed.time, smoothed.q, given.start, given.warnings)
    return Within(given, attitude, flown, smoothed.attitude, tolerance_deg, smoothed)
