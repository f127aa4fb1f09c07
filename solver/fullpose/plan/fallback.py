"""Paths that are taken sample by sample: inside every limit, exact wherever that could be had."""

import numpy as np

from fullpose._typing import Array
from fullpose.methods import METHODS
from fullpose.preview.flight import PreviewFlight
from fullpose.preview.options import PreviewOptions
from fullpose.rig import Rig
from fullpose.verify import attitude_errors, payload_attitudes

# [s] known and [s] between two ways, of the previews
FORESIGHTS = ((4.0, 0.2), (8.0, 0.5))
EXACT_ERROR = 1e-12  # [rad] of attitude error above which a sample is not exact
FORESEEN = 600.0  # [s] of a flight that they are tried for: they take a tenth of its length


class Fallback:
    """Such paths of one flight on a four-axis rig, (n, 4) [rad] each: made when they are asked for, and kept.

    time (n,) [s], attitude (n, 3, 3); start (4,) [rad] exact, or None. Nothing here changes a path once it is made.
    """

    def __init__(self, time: Array, attitude: Array, rig: Rig, start: Array | None) -> None:
        self._flight = time, attitude
        self._rig = rig
        self._start = start
        self._exact: Array | None = None
        self._foreseen: list[Array] | None = None

    def exact(self) -> Array:
        """By the step method `exact`."""
        if self._exact is None:
            method = METHODS["exact"]
            stepper = method.stepper(self._rig, method.options(), self._start, self._flight[1][0])
            self._exact = stepper.block(*self._flight).angles
        return self._exact

    def foreseen(self) -> list[Array]:
        """By `preview`, which may know much of the flight here; none of a flight that is too long for it."""
        time, attitude = self._flight
        if self._foreseen is None:
            self._foreseen = []
            for preview_s, replan_s in FORESIGHTS if time[-1] - time[0] <= FORESEEN else ():
                options = PreviewOptions(preview_s=preview_s, replan_s=replan_s)
                flown = PreviewFlight(self._rig, options, self._start, time, attitude).block(time, attitude)
                self._foreseen.append(flown.angles)
        return self._foreseen

    def closest(self) -> Array:
        """A copy of the one with the least mean squared attitude error."""
        attitude = self._flight[1]

        def missed(way: Array) -> float:
            return float(np.mean(attitude_errors(payload_attitudes(self._rig, way), attitude)[0] ** 2))

        return min((self.exact(), *self.foreseen()), key=missed).copy()
