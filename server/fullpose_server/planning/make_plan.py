"""Making one plan: a stored flight, brought to the rig's rate, solved, given its leads, checked, and written."""

import math
import time
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from fullpose._typing import Array
from fullpose.attitude import dcm_from_quaternion, quaternion_from_dcm
from fullpose.errors import MethodError
from fullpose.lead import lead_in, lead_out
from fullpose.plan import Plan
from fullpose.plan.recorded_noise import recorded_noise
from fullpose.plan.verdict import margins
from fullpose.recorded import Smoothed, smooth
from fullpose.registry import method_options
from fullpose.resample import Resampled, continuous, resample
from fullpose.rig import Rig
from fullpose.solution import Solution
from fullpose.solve import solve_flight
from fullpose.verify import verify
from fullpose.vocabulary import RemedyKind
from fullpose_server.formats.flight_folder import read_arrays
from fullpose_server.formats.plan_folder import PlanOrigin, PlanPath, make_plan, rig_hash, write_plan
from fullpose_server.formats.report import exceeds, make_report, margins_report, verdict_report, why_infeasible
from fullpose_server.planning.flown_within import Within, behind, flown_within
from fullpose_server.planning.plan_request import PlanRequest
from fullpose_server.planning.remaining_tolerance import with_remaining
from fullpose_server.planning.remedy import find_remedy, refuse_noise, tolerated
from fullpose_server.planning.remedy_request import RemedyRequest

Progress = Callable[[str, int, int], None]  # phase, done, total
_NONE = np.empty((0, 4))


def make_plan_folder(values: dict[str, Any], progress: Progress) -> dict[str, Any]:
    """Make the plan of a `PlanRequest`, as JSON has it, and write its folder.

    Returns what the store keeps of it, JSON-ready.

    Raises `fullpose.errors.SolverError`. An infeasible flight is no error: it is written, not flyable.
    """
    request = PlanRequest.from_json(values)
    progress("resample", 0, 1)
    given = _given(request)
    if request.remedy is not None:
        refuse_noise(_asked(request.remedy), given.time, given.attitude, request.rig)
    flight = resample(given.time, given.q, request.rate_hz)
    if flight.time.size < 2:
        flight = _held(flight, request.rate_hz)
    made = _solve(request, given.smoothed, flight, progress)
    solution = made.solution
    at, rig = solution.time, solution.rig
    progress("verify", 0, 1)
    report = make_report(solution, verify(at, solution.angles, rig, dcm_from_quaternion(made.q)))
    report["rig"] = request.rig.name
    if made.planned is not None:
        report |= verdict_report(made.planned)
    report = given.reported_on_top(report)
    if made.remedy.get("kind") == RemedyKind.TOLERANCE and made.remedy["value"]:
        report |= tolerated(made.remedy)
    refusal = why_infeasible(report)
    before, after = _NONE, _NONE
    if refusal is None:
        progress("leads", 0, 1)
        try:
            before, after = made.leads()
        except MethodError as error:
            refusal = f"the flight itself fits, its way in or out from rest does not: {error}"
    angles = np.concatenate([before, solution.angles, after])
    if refusal is None:
        refusal = _path_refusal(angles, request.rate_hz, rig, len(before))
    remedy = made.remedy | {"sufficient": refusal is None} if made.remedy else None  # leads count, too
    if refusal is None and rig_hash(rig) != rig_hash(request.rig):
        refusal = f"it needs {made.remedy['statement']}: give the rig that, and plan again"
    progress("write", 0, 1)
    result = _write(request, flight, made, report, refusal, angles, (len(before), len(after)))
    shown = margins_report(margins(at, solution.angles, rig), rig)
    return result | {"verdict": made.verdict, "margins": shown, "remedy": remedy}


def _given(request: PlanRequest) -> Within:
    """The stored flight within the tolerance asked for; for the remedy tolerance, the flight behind its noise."""
    time_s, q = (np.array(column) for column in read_arrays(request.trajectory))
    wanted = None if request.remedy is None else _asked(request.remedy).kind
    if request.tolerance_deg is None and wanted == RemedyKind.TOLERANCE:
        attitude = dcm_from_quaternion(q)
        if (noise := recorded_noise(time_s, attitude)) is not None:
            return behind(time_s, q, smooth(time_s, attitude, noise.suggested, noise.diagnosis))
    return flown_within(time_s, q, request.tolerance_deg)


def _held(moment: Resampled, rate_hz: float) -> Resampled:
    """A flight of one sample, held for one period: what is flown is a way from one sample to the next."""
    return replace(
        moment,
        time=moment.time[0] + np.arange(2) / rate_hz,
        q=moment.q.repeat(2, axis=0),
        body_rate=np.zeros((2, 3)),
        sentence=f"one sample at {rate_hz:g} Hz, held for one period",
    )


@dataclass(frozen=True)
class _Made:
    """A solution, what its verdict rests on, and how to get its leads (which may raise `MethodError`).

    `q` (n, 4) is the attitude that was solved, `solution.rig` the rig; both are the remedy's where it has changed them.
    """

    solution: Solution
    q: Array
    verdict: str
    leads: Callable[[], tuple[Array, Array]]
    planned: Plan | None = None  # of the planner's solutions
    remedy: dict[str, Any] = field(default_factory=dict)


def _solve(request: PlanRequest, smoothed: Smoothed | None, flight: Resampled, progress: Progress) -> _Made:
    at, q = flight.time - flight.time[0], flight.q
    attitude = dcm_from_quaternion(q)
    options = with_remaining(request.method, method_options(request.method, request.options), smoothed)
    start = None if request.start is None else np.array(request.start)

    def tell(done: int, total: int) -> None:
        progress("solve", done, total)

    clock = time.perf_counter
    if request.remedy is not None:
        return _remedied(request, at, attitude, start, options, smoothed, tell)
    solved = solve_flight(
        at, attitude, request.rig, method=request.method, options=options, start=start, clock=clock, progress=tell
    )
    solution, made = solved.solution, solved.plan
    if made is not None:  # it keeps room for its own leads and says what its verdict rests on
        return _Made(solution, q, made.verdict.statement, lambda: _planned(made), made)
    verdict = "Every sample checked against the limits by code apart from the solver; another method may find more."
    return _Made(solution, q, verdict, lambda: _leads(solution))


def _asked(remedy: dict[str, Any]) -> RemedyRequest:
    return RemedyRequest(remedy["kind"], remedy.get("frame"), remedy.get("limit"))


def _remedied(
    request: PlanRequest,
    at: Array,
    attitude: Array,
    start: Array | None,
    options: Any,
    smoothed: Smoothed | None,
    tell: Callable[[int, int], None],
) -> _Made:
    """The flight, changed until it fits; solved by the planner whatever the method of the plan it is a remedy of."""
    found = find_remedy(
        _asked(request.remedy or {}),
        at,
        attitude,
        request.rig,
        start=start,
        options=options,
        progress=tell,
        smoothed=smoothed,
    )
    plan = found.remedy.plan
    q = continuous(quaternion_from_dcm(found.remedy.attitude))
    # A rig with a limit raised is still that rig by name: the plan's page compares the two.
    solution = replace(plan.solution, rig=replace(plan.solution.rig, name=request.rig.name))
    return _Made(solution, q, plan.verdict.statement, lambda: _planned(plan), plan, found.described)


def _planned(plan: Plan) -> tuple[Array, Array]:
    """The planner's own leads. Raises `MethodError` where there are none."""
    if plan.lead_refusal:
        raise MethodError(plan.lead_refusal)
    return plan.lead_in, plan.lead_out


def _write(
    request: PlanRequest,
    flight: Resampled,
    made: _Made,
    report: dict[str, Any],
    refusal: str | None,
    angles: Array,
    leads: tuple[int, int],
) -> dict[str, Any]:
    n = len(angles)
    solution = made.solution
    inner = slice(leads[0], n - leads[1])
    target, error = np.full((n, 4), math.nan), np.full(n, math.nan)
    target[inner], error[inner] = made.q, solution.error
    origin = PlanOrigin(
        request.plan_id,
        request.trajectory_sha256,
        request.method,
        request.name,
        start_s=float(flight.time[0]),
        tolerance_deg=request.tolerance_deg,
    )
    path = PlanPath(angles, target, error, *leads)
    folder = make_plan(origin, solution.rig, request.rate_hz, path, feasible=refusal is None)
    write_plan(request.folder, folder)
    return {
        "report": report,
        "feasible": report["feasible"],
        "refusal": refusal,
        "plan_hash": folder.info.plan_hash,
        "format": folder.info.format,
        "samples": n,
        "duration_s": folder.info.duration_s,
        "lead_in_s": leads[0] / request.rate_hz,
        "lead_out_s": leads[1] / request.rate_hz,
        "resampling": flight.sentence,
    }


def _leads(solution: Solution) -> tuple[Array, Array]:
    """The ways from rest to a flight and back to it. Raises `MethodError` where there is no room for one."""
    time, angles, rig = solution.time, solution.angles, solution.rig
    into, out = lead_in(time[:3], angles[:3], rig), lead_out(time[-3:], angles[-3:], rig)
    for lead in (into, out):
        if lead.refusal:
            raise MethodError(lead.refusal)
    return into.angles, out.angles


def _path_refusal(angles: Array, rate_hz: float, rig: Rig, lead: int) -> str | None:
    """Why the path, leads included, is not inside the limits; None where it is."""
    at = (np.arange(len(angles)) - lead) / rate_hz
    violations = verify(at, angles, rig, None).violations
    if not violations:
        return None
    first = violations[0]
    return f"with its leads: {exceeds(first.time, first.frame, first.limit, math.degrees(first.value))}"
