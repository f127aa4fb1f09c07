"""`plan`: the whole flight at once (mathematics, section 8)."""

import math
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike

from fullpose._typing import Array, Clock, Progress
from fullpose.bounds import EXACT
from fullpose.flight import check_flight, check_start, check_start_rate
from fullpose.lead import lead_in, lead_out
from fullpose.methods.start_pose import start_pose
from fullpose.plan.beam_path import attainable_rates
from fullpose.plan.decision import Flown, fly, fly_three_axis
from fullpose.plan.fallback import EXACT_ERROR, Fallback
from fullpose.plan.impossible import beyond_all_frames
from fullpose.plan.reason import reason_of
from fullpose.plan.refinement import Task
from fullpose.plan.verdict import Margins, Verdict, check, margins, verdict_on, with_least_tolerance, with_reason
from fullpose.rig import Rig
from fullpose.solution import Solution
from fullpose.trajectory.curve import polish
from fullpose.trajectory.options import PlanOptions
from fullpose.trajectory.problem import Problem
from fullpose.vocabulary import Decision

CONSTANT = 1e-14  # range of an entry of C up to which an attitude counts as constant: what rounding leaves


@dataclass(frozen=True)
class Plan:
    """A flight's plan: the solution, the verdict on it, its margins, and the way from rest to it and back.

    `lead_in`, `lead_out` (m, 4) [rad] at the flight's sample interval, without the flight's own first and last
    sample; empty where the flight begins or ends at rest, or where `lead_refusal` says why there is none.
    """

    solution: Solution
    verdict: Verdict
    margins: Margins
    lead_in: Array
    lead_out: Array
    node_paths: int  # how many node paths were refined
    lead_refusal: str = ""

    @property
    def ready(self) -> bool:
        """Whether a rig can fly it: feasible, with a way from rest to it and back to rest."""
        return self.verdict.feasible and not self.lead_refusal


def plan(
    time: ArrayLike,
    attitude: ArrayLike,
    rig: Rig,
    start: ArrayLike | None = None,
    start_rate: ArrayLike | None = None,
    options: PlanOptions | None = None,
    progress: Progress | None = None,
    clock: Clock | None = None,
) -> Plan:
    """Plan a flight: time (n,) [s], attitude (n, 3, 3) body from reference.

    start (4,) [rad]: the flight starts at the exact pose nearest to it; None: wherever is best. start_rate (4,)
    [rad/s]: the frames' rates over the first interval; what the attitude leaves free of them, the component along the
    self-motion, is kept to 1e-4 of the lowest rate limit, or the flight is not feasible. None: free. A three-axis rig
    has nothing free, nor has a flight of one sample. progress(done, total) is called as the work goes and may raise
    `CancelledError`; clock reads seconds.

    Raises `InputError` for arrays that are no flight, a start outside the rig's range or a start rate above its limits.
    """
    t, C = check_flight(time, attitude)
    near = check_start(start, rig)
    rate = check_start_rate(start_rate, rig)
    return plan_problem(Problem(t, C, rig, options or PlanOptions(), near, rate), progress, clock)


def plan_problem(problem: Problem, progress: Progress | None = None, clock: Clock | None = None) -> Plan:
    """Plan a flight that was checked; its start is what the first pose is to be near."""
    now = clock or _no_clock
    begin = now()
    return _finished(problem, _flown(problem, progress), lambda: now() - begin)


def _no_clock() -> float:
    return math.nan


def _flown(problem: Problem, progress: Progress | None) -> Flown:
    if not problem.rig.geometry.redundant:
        return fly_three_axis(problem)
    n = len(problem)
    exact = _from_exact_start(problem)
    rate = problem.start_rate
    if np.ptp(problem.attitude, axis=0).max() <= CONSTANT and (rate is None or not rate.any()):
        one = replace(exact.part(0, 1), start_rate=None)  # it stands, and one sample says where
        return fly(Task(one, Fallback(one), progress)).held(n)
    return fly(Task(exact, Fallback(exact), progress))


def _from_exact_start(problem: Problem) -> Problem:
    """The problem with the exact pose nearest to its start, and what the attitude leaves of its start rate."""
    rate = problem.start_rate if len(problem) > 1 else None
    if problem.start is None:
        return replace(problem, start_rate=rate)
    start, _ = start_pose(problem.rig, problem.attitude[0], problem.start)
    if rate is not None:
        interval = float(problem.time[1] - problem.time[0])
        rate = attainable_rates(problem.attitude[1], interval, problem.rig, start[None], rate)[0]
    return replace(problem, start=start, start_rate=rate)


def _finished(problem: Problem, flown: Flown, stopwatch: Clock) -> Plan:
    """The last digits, the independent check, the verdict, the leads and the margins."""
    time, attitude, rig = problem.time, problem.attitude, problem.rig
    n = len(time)
    angles = _polished(problem, flown)
    found = check(time, attitude, angles, rig)
    verdict = verdict_on(found, rig, flown.blocking, flown.decided_by, flown.grid, flown.tried)
    exact = verdict.feasible and flown.decided_by is not Decision.TOLERANCE
    if exact or problem.options.best_effort:
        verdict = with_least_tolerance(verdict, found, exact)
        if not exact:
            verdict = _explained(problem, verdict, angles, found.error)
    into, out = lead_in(time[:3], angles[:3], rig), lead_out(time[-3:], angles[-3:], rig)
    elapsed = stopwatch()
    solution = Solution(
        "plan", rig, time, angles, found.error, found.matrix_error, flown.limited, flown.iterations,
        np.full(n, elapsed / n), elapsed, verdict.blocking,
    )  # fmt: skip
    refusal = "; ".join(lead.refusal for lead in (into, out) if lead.refusal)
    room = margins(time, angles, rig)
    return Plan(solution, verdict, room, into.angles, out.angles, flown.node_paths, refusal)


def _explained(problem: Problem, verdict: Verdict, angles: Array, error: Array) -> Verdict:
    """The verdict with what happens first along the angles, and what then."""
    if verdict.decided_by is Decision.BEYOND:
        return replace(verdict, beyond=beyond_all_frames(problem.time, problem.attitude, problem.rig))
    closed = -math.inf
    if verdict.closed is not None and problem.rig.geometry.redundant:
        closed = verdict.closed.time
    found = reason_of(problem.time, problem.attitude, angles, error > EXACT_ERROR, problem.rig, closed)
    return with_reason(verdict, found)


def _polished(problem: Problem, flown: Flown) -> Array:
    """The angles with their last digits: exact samples by the charts, the others inside their ranges."""
    rig, angles = problem.rig, flown.angles
    if not rig.geometry.redundant:
        return angles
    exact = flown.limited == EXACT
    if exact.all():
        polish(rig.geometry.horizontal, problem.attitude, angles)
        return angles
    kept = np.ascontiguousarray(angles[exact])
    polish(rig.geometry.horizontal, np.ascontiguousarray(problem.attitude[exact]), kept)
    angles[exact] = kept
    angles[~exact] = np.clip(angles[~exact], rig.position_min, rig.position_max)  # the last 1e-9 rad
    return angles
