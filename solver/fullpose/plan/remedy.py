"""What a remedy is, and the trials by which one is searched: the whole planner behind each.

A search has so many trials at most, and what is returned is planned from every sample. `progress(done, total)` counts
trials and is called within each; from it a caller may raise `CancelledError`, or `OutOfTimeError`, which gives up the
one trial that is on and lets the search go on: a trial that was given up counts as one that does not do.
"""

from contextlib import suppress
from dataclasses import dataclass, replace

from numpy.typing import ArrayLike

from fullpose._typing import Array, Progress
from fullpose.errors import OutOfTimeError
from fullpose.plan.plan import Plan, plan
from fullpose.rig import Rig
from fullpose.trajectory.options import PlanOptions
from fullpose.vocabulary import RemedyKind

TRIAL_INTERVAL = 0.005  # [s] between the samples that a trial looks at
NOTHING = "nothing"  # what is changed of a flight that fits as it is


@dataclass(frozen=True)
class Remedy:
    """A remedy: what was changed and by how much, and the flight, rig and plan that come of it.

    `value` is the factor on the time of a slow-down; an offset's angle [rad], `what` being the axis; the new limit,
    `what` being frame and limit; or the tolerance [rad] (`NOTHING`, value 0, where none of these need be changed).
    `plan.ready` says whether it suffices. `fails_again` is a larger value, of those looked at, for which the flight
    does not fit although it does for this one: what a search by halves assumes not to be; None where none was met.
    """

    kind: RemedyKind
    what: str
    value: float
    time: Array  # (n,) [s]
    attitude: Array  # (n, 3, 3)
    rig: Rig
    plan: Plan
    fails_again: float | None = None
    deviation: Array | None = None  # (n,) [rad] of a tolerance, from the flight as it was given
    given_up: int = 0  # trials that took too long


@dataclass
class Trials:
    """Counts trials for the progress callback and plans them."""

    total: int
    progress: Progress | None
    options: PlanOptions
    start: ArrayLike | None
    done: int = 0
    given_up: int = 0

    @property
    def quick(self) -> PlanOptions:
        """The options of a trial."""
        return replace(self.options, best_effort=False, alternatives=min(2, self.options.alternatives))

    def feasible(self, time: Array, attitude: Array, rig: Rig) -> Plan | None:
        """A trial: a plan without best effort, on the thinned samples; None where it was given up."""
        self.done += 1
        part = slice(None, None, _stride(time))
        return self._watched(time[part], attitude[part], rig, self.quick)

    def fits(self, time: Array, attitude: Array, rig: Rig) -> bool:
        """Whether a trial does."""
        made = self.feasible(time, attitude, rig)
        return made is not None and made.ready

    def exact(self, time: Array, attitude: Array, rig: Rig) -> Plan | None:
        """A trial of every sample and every alternative, without best effort; None where it was given up."""
        self.done += 1
        return self._watched(time, attitude, rig, replace(self.options, best_effort=False))

    def _watched(self, time: Array, attitude: Array, rig: Rig, options: PlanOptions) -> Plan | None:
        try:
            self._tell()
            return plan(time, attitude, rig, self.start, options=options, progress=lambda _done, _total: self._tell())
        except OutOfTimeError:
            self.given_up += 1
            return None

    def _tell(self) -> None:
        if self.progress is not None:
            self.progress(min(self.done, self.total), self.total)

    def _tell_last(self) -> None:
        """The plan that is returned may be cancelled, and is not given up."""
        with suppress(OutOfTimeError):
            self._tell()

    def final(self, time: Array, attitude: Array, rig: Rig, options: PlanOptions | None = None) -> Plan:
        """The plan that is returned, from every sample; options: in place of the search's own."""
        self.done = max(self.done, self.total - 1)
        made = plan(
            time, attitude, rig, self.start, options=options or self.options,
            progress=lambda _done, _total: self._tell_last(),
        )  # fmt: skip
        self.done = self.total
        if self.progress is not None:
            self.progress(self.total, self.total)
        return made


def _stride(time: Array) -> int:
    n = len(time)
    return max(1, int(TRIAL_INTERVAL * (n - 1) / (time[-1] - time[0]))) if n > 16 else 1
