"""`plan`: the whole flight at once (mathematics, section 8)."""

import math
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike

from fullpose._typing import Array, Codes, Counts, Progress
from fullpose.bounds import EXACT, limited_code
from fullpose.errors import InputError
from fullpose.flight import check_flight, check_start
from fullpose.methods.start_pose import start_pose
from fullpose.plan.lead import lead_in, lead_out
from fullpose.plan.least_error import BestEffort, afresh, least_error
from fullpose.plan.strategies import Search
from fullpose.plan.three_axis import three_axis_path
from fullpose.plan.verdict import Margins, Verdict, check, margins
from fullpose.rig import FRAMES, LIMITS, Limit, Rig
from fullpose.solution import Blocking, Solution
from fullpose.trajectory.curve import polish
from fullpose.trajectory.nodes import OVERLAP
from fullpose.trajectory.options import PlanOptions
from fullpose.trajectory.sqp import MET, RATE_MET
from fullpose.trajectory.windows import Path, overrun
from fullpose.vocabulary import Decision

STRETCH = 4.0  # times the rate limit that an edge may take, at a price, for a flight without a node path
BROKEN = 100.0  # times a limit: a path that jumps, of no use to begin with
STILL = 1e-14  # range of an entry of C up to which an attitude counts as constant: what rounding leaves
STEPS_AFTER = 2  # attempts, before the step method is asked: it is quick, and what it flies need not be searched for
EXCESS = 100.0  # cost of going over a rate limit by its whole, for a flight without a node path


@dataclass(frozen=True)
class Plan:
    """A flight's plan: the solution, the verdict on it, its margins, and the way from rest to it and back.

    `lead_in`, `lead_out` (m, 4) [rad] at the flight's sample interval, without the flight's own first and last
    sample; empty where the flight begins or ends at rest, or where `lead_note` says why there is none.
    """

    solution: Solution
    verdict: Verdict
    margins: Margins
    lead_in: Array
    lead_out: Array
    node_paths: int  # how many node paths were refined
    lead_note: str = ""

    @property
    def ready(self) -> bool:
        """Whether a rig can fly it: feasible, with a way from rest to it and back to rest."""
        return self.verdict.feasible and not self.lead_note


def plan(
    time: ArrayLike,
    attitude: ArrayLike,
    rig: Rig,
    start: ArrayLike | None = None,
    start_rate: ArrayLike | None = None,
    options: PlanOptions | None = None,
    progress: Progress | None = None,
    clock: Callable[[], float] | None = None,
) -> Plan:
    """Plan a flight: time (n,) [s], attitude (n, 3, 3) body from reference.

    start (4,) [rad]: the flight starts at the exact pose nearest to it; None: wherever is best. start_rate (4,)
    [rad/s]: the frames' rates over the first interval; what the attitude leaves free of them, the component along the
    self-motion, is kept to 1e-4 of the lowest rate limit, or the flight is not feasible. None: free. A three-axis rig
    has nothing free, nor has a flight of one sample. progress(done, total) is called as the work goes and may raise
    `CancelledError`; clock reads seconds.

    Raises `InputError` for arrays that are no flight, a start outside the rig's range or a start rate above its limits.
    """
    options = options or PlanOptions()
    t, C = check_flight(time, attitude)
    near = check_start(start, rig)
    rate = check_start_rate(start_rate, rig)
    begin = clock() if clock else math.nan
    if not rig.geometry.redundant:
        return _finished(t, C, rig, _three_axis(t, C, rig, near, options), 0, begin, clock)
    at = None
    if near is not None:
        at, _ = start_pose(rig, C[0], near)
    if np.ptp(C, axis=0).max() <= STILL and (rate is None or not rate.any()):  # it stands, and one sample says where
        search = Search(t[:1], C[:1], rig, at, None, options, progress)
        return _finished(t, C, rig, _fly(search).held(len(t)), search.node_paths, begin, clock)
    search = Search(t, C, rig, at, rate if len(t) > 1 else None, options, progress)
    return _finished(t, C, rig, _fly(search), search.node_paths, begin, clock)


def check_start_rate(rate: ArrayLike | None, rig: Rig) -> Array | None:
    """The start rate (4,) [rad/s], or None. Raises `InputError` where it is not a rate of the rig."""
    if rate is None:
        return None
    v = np.ascontiguousarray(rate, dtype=np.float64)
    if v.shape != (4,) or not np.isfinite(v).all():
        raise InputError("start_rate", None, v.tolist(), "four finite rates in rad/s, base first")
    for i in rig.geometry.frames:
        if abs(v[i]) > rig.max_rate[i]:
            raise InputError(
                f"start_rate of the {FRAMES[i]} frame", None, float(v[i]), f"at most {rig.max_rate[i]:.6g} rad/s"
            )
    return v


@dataclass(frozen=True)
class _Flown:
    """What the search came to: angles (n, 4), iterations (n,), limited codes (n,), and who decided if it failed."""

    angles: Array
    iterations: Counts
    limited: Codes
    decided_by: Decision
    blocking: Blocking | None
    grid: float

    def held(self, n: int) -> "_Flown":
        """Its first sample, held over n."""
        angles, iterations = np.repeat(self.angles[:1], n, axis=0), np.repeat(self.iterations[:1], n)
        return replace(self, angles=angles, iterations=iterations, limited=np.repeat(self.limited[:1], n))


def _fly(search: Search) -> _Flown:
    """Node paths, refined, until one is inside the limits; else the least error."""
    options, time, rig = search.options, search.time, search.rig
    n = len(time)
    grid = options.grid
    slack = 0.0
    none = np.zeros(n, np.int16)
    node_path = search.node_path(grid)
    if not node_path.found:
        grid = options.fine_grid
        wide = search.node_path(grid, slack=grid / OVERLAP)
        if wide.found:
            node_path = search.node_path(grid)
            if not node_path.found:
                node_path, slack = wide, grid / OVERLAP
        else:
            node_path = wide
    if not node_path.found:
        blocking = Blocking(
            float(time[search.samples[node_path.reached]]), FRAMES[node_path.frame], LIMITS[node_path.limit]
        )
        closed = {Limit.POSITION: Decision.POSITION, Limit.RATE: Decision.RATE, Limit.ACCELERATION: Decision.START_RATE}
        decided_by = closed[blocking.limit]  # only the inertia of a start rate closes a node path by acceleration
        angles = np.repeat(rig.home[None], n, axis=0)
        limited = np.full(n, limited_code(node_path.frame, node_path.limit), np.int16)
        if options.best_effort:
            effort = _least_error(search)
            angles, limited = effort.angles, effort.limited
        return _Flown(angles, np.zeros(n, np.int32), limited, decided_by, blocking, grid)
    best: tuple[float, Path] | None = None
    for attempt in range(options.alternatives + 1):
        if attempt == STEPS_AFTER and (fallback := search.refine_step(search.fallback.exact())) is not None:
            return _Flown(fallback.angles, fallback.iterations, none, Decision.CHECKED, None, grid)
        if attempt > 0:
            following = search.alternative(attempt, grid, slack)
            if not following.found:
                continue
            node_path = following
        path = search.refine(node_path)
        over = max(overrun(time, path.angles, rig)[0], search.missed(path) - RATE_MET)
        if best is None or over < best[0]:
            best = over, path
        if over <= MET:
            return _Flown(path.angles, path.iterations, none, Decision.CHECKED, None, grid)
        search.steer_away(path)
    assert best is not None
    path = best[1]
    over, sample, frame, limit = overrun(time, path.angles, rig)
    blocking = Blocking(float(time[sample]), FRAMES[frame], LIMITS[limit])
    decided_by = Decision.ACCELERATION
    if over <= MET:  # inside every limit, but for the start rate
        assert search.start_rate is not None
        off = np.abs(search.start_rate - (path.angles[1] - path.angles[0]) / (time[1] - time[0]))
        blocking, decided_by = Blocking(float(time[1]), FRAMES[int(np.argmax(off))], Limit.RATE), Decision.START_RATE
    if not options.best_effort:
        return _Flown(path.angles, path.iterations, none, decided_by, blocking, grid)
    for way in search.fallback.foreseen():
        if (fallback := search.refine_step(way)) is not None:
            return _Flown(fallback.angles, fallback.iterations, none, Decision.CHECKED, None, grid)
    effort = least_error(time, search.attitude, path.angles, rig, options, search.start, search.fallback)
    if not effort.limited.any() and search.start_rate is None:  # not even that gave the attitude up
        return _Flown(effort.angles, path.iterations, effort.limited, Decision.CHECKED, None, grid)
    return _Flown(effort.angles, path.iterations, effort.limited, decided_by, blocking, grid)


def _least_error(search: Search) -> BestEffort:
    """For a flight without a node path: from the node path that is least over the limits, the least attitude error."""
    search.avoid.clear()
    time, attitude, rig, options = search.time, search.attitude, search.rig, search.options
    for slack in (0.0, 0.5):
        node_path = search.node_path(options.grid, slack=slack, stretch=STRETCH, excess=EXCESS)
        if not node_path.found:
            continue
        if overrun(time, search.curve(node_path), rig)[0] > BROKEN:
            break
        path = search.refine(node_path)
        return least_error(time, attitude, path.angles, rig, options, search.start, search.fallback)
    return afresh(time, attitude, np.empty((0, 4)), rig, options, search.start, search.fallback)


STATEMENTS = {
    Decision.CHECKED: "Feasible: every sample checked by code apart from the planner.",
    Decision.POSITION: (
        "Infeasible: at the blocking time no exact pose lies inside the position limits that can be reached; "
        "no path of nodes exists on the grid even with every range and edge widened by the grid's covering step. "
        "Grid-complete away from the singularity, not a theorem."
    ),
    Decision.RATE: (
        "Infeasible: no path of nodes obeys the rate limits past the blocking time, even with every edge widened "
        "by the grid's covering step. Grid-complete away from the singularity, not a theorem."
    ),
    Decision.ACCELERATION: (
        "Infeasible as far as the search went: node paths inside the rate limits exist, but none of those "
        "refined came inside every limit, with or without regard to the accelerations; "
        "the blocking place is the worst of the best one. Evidence, not a proof."
    ),
    Decision.START_RATE: (
        "Infeasible with the start rate asked for: no path was found that takes it up inside the limits; the "
        "blocking frame is the one it fails by. Evidence, not a proof."
    ),
    Decision.THREE_AXIS: "Infeasible: a three-axis rig has no freedom but the choice of the Euler set and its turns.",
}


def _finished(
    time: Array,
    attitude: Array,
    rig: Rig,
    flown: _Flown,
    node_paths: int,
    begin: float,
    clock: Callable[[], float] | None,
) -> Plan:
    angles = flown.angles
    if rig.geometry.redundant and not flown.limited.any():
        polish(rig.geometry.horizontal, attitude, angles)
    elif rig.geometry.redundant:
        exact = flown.limited == EXACT
        kept = np.ascontiguousarray(angles[exact])
        polish(rig.geometry.horizontal, np.ascontiguousarray(attitude[exact]), kept)
        angles[exact] = kept
        angles[~exact] = np.clip(angles[~exact], rig.position_min, rig.position_max)  # the last 1e-9 rad
    found = check(time, attitude, angles, rig)
    blocking, decided_by = flown.blocking, flown.decided_by
    if blocking is None and found.violations:
        first = found.violations[0]
        blocking = Blocking(first.time, first.frame, first.limit)
        decided_by = Decision.ACCELERATION if rig.geometry.redundant else Decision.THREE_AXIS
    between = found.between
    statement = f"{STATEMENTS[decided_by]} {between.sentence()}" if blocking is None else STATEMENTS[decided_by]
    verdict = Verdict(
        blocking is None, blocking, decided_by, flown.grid, statement, between.matrix, between.angle
    )  # fmt: skip
    inn, in_note = lead_in(time[:3], angles[:3], rig)
    out, out_note = lead_out(time[-3:], angles[-3:], rig)
    elapsed = (clock() - begin) if clock else math.nan
    solution = Solution(
        "plan", rig, time, angles, found.error, found.matrix_error, flown.limited, flown.iterations,
        np.full(len(time), elapsed / len(time)), elapsed, blocking,
    )  # fmt: skip
    note = "; ".join(part for part in (in_note, out_note) if part)
    return Plan(solution, verdict, margins(time, angles, rig), inn, out, node_paths, note)


def _three_axis(time: Array, attitude: Array, rig: Rig, start: Array | None, options: PlanOptions) -> _Flown:
    """Without freedom: the Euler angles; where they leave the limits, the least error inside them."""
    angles = three_axis_path(time, attitude, rig, start)
    over, sample, frame, limit = overrun(time, angles, rig)
    iterations, limited = np.zeros(len(time), np.int32), np.zeros(len(time), np.int16)
    if over <= MET:
        return _Flown(angles, iterations, limited, Decision.CHECKED, None, math.nan)
    blocking = Blocking(float(time[sample]), FRAMES[frame], LIMITS[limit])
    if not options.best_effort:
        return _Flown(angles, iterations, limited, Decision.THREE_AXIS, blocking, math.nan)
    effort = least_error(time, attitude, angles, rig, options)
    return _Flown(effort.angles, iterations, effort.limited, Decision.THREE_AXIS, blocking, math.nan)
