"""Making one plan: a stored flight, brought to the rig's rate, solved, given its leads, checked, and written."""

import math
import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from server.plan_folder import make_plan, write_plan
from server.store.errors import StoreError
from server.store.options import PLAN, method_options
from server.store.planning_request import PlanRequest
from server.store.report import make_report, why_infeasible
from server.store.trajectories import read_arrays
from solver.attitude import dcm_from_quaternion
from solver.errors import MethodError
from solver.lead import lead_in, lead_out
from solver.planner import plan
from solver.planner.verdict import margins
from solver.resample import Resampled, resample
from solver.rig import FRAMES
from solver.solution import Solution
from solver.solve import solve
from solver.verify import Violation, verify

Progress = Callable[[str, int, int], None]  # phase, done, total
Array = NDArray[np.float64]
_NONE = np.empty((0, 4))


def make_plan_folder(request: PlanRequest, progress: Progress) -> dict[str, Any]:
    """Make the plan and write its folder; returns what the store keeps of it, JSON-ready.

    Raises `StoreError`, `solver.errors.SolverError`. An infeasible flight is no error: it is written, not flyable.
    """
    progress("resample", 0, 1)
    time_s, q = read_arrays(request.trajectory)
    flight = resample(np.array(time_s), np.array(q), request.rate_hz)
    if flight.time.size < 2:
        raise StoreError(f"a flight of at least two samples at {request.rate_hz:g} Hz is needed, this one is a moment")
    at = flight.time - flight.time[0]
    attitude = dcm_from_quaternion(flight.q)
    made = _solve(request, at, attitude, progress)
    solution = made.solution
    progress("verify", 0, 1)
    report = make_report(solution, verify(at, solution.angles, request.rig, attitude))
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
        refusal = _whole(angles, request, len(before))
    progress("write", 0, 1)
    result = _write(request, flight, solution, report, refusal, angles, (len(before), len(after)))
    return result | {"verdict": made.verdict, "margins": _margins(at, solution)}


@dataclass(frozen=True)
class _Made:
    """A solution, what its verdict rests on, and how to get its leads (which may raise `MethodError`)."""

    solution: Solution
    verdict: str
    leads: Callable[[], tuple[Array, Array]]


def _solve(request: PlanRequest, at: Array, attitude: Array, progress: Progress) -> _Made:
    options = method_options(request.method, request.options)
    start = None if request.start is None else np.array(request.start)

    def tell(done: int, total: int) -> None:
        progress("solve", done, total)

    clock = time.perf_counter
    if request.method == PLAN:
        # Asked directly: the planner keeps room for its own leads and says what its verdict rests on.
        whole = plan(at, attitude, request.rig, start=start, options=options, clock=clock, progress=tell)

        def planned() -> tuple[Array, Array]:
            if whole.lead_note:
                raise MethodError(whole.lead_note)
            return whole.lead_in, whole.lead_out

        return _Made(whole.solution, whole.verdict.statement, planned)
    solution = solve(
        at, attitude, request.rig, method=request.method, options=options, start=start, clock=clock, progress=tell
    )
    verdict = "Every sample checked against the limits by code apart from the solver; another method may find more."
    return _Made(solution, verdict, lambda: _leads(solution, request.rate_hz))


def _write(
    request: PlanRequest,
    flight: Resampled,
    solution: Solution,
    report: dict[str, Any],
    refusal: str | None,
    angles: Array,
    leads: tuple[int, int],
) -> dict[str, Any]:
    n = len(angles)
    inner = slice(leads[0], n - leads[1])
    target, error = np.full((n, 4), math.nan), np.full(n, math.nan)
    target[inner], error[inner] = flight.q, solution.error
    folder = make_plan(
        plan_id=request.plan_id,
        rig=request.rig,
        rate_hz=request.rate_hz,
        angles=angles,
        target=target,
        error=error,
        lead_in_samples=leads[0],
        lead_out_samples=leads[1],
        trajectory_sha256=request.trajectory_sha256,
        method=request.method,
        feasible=refusal is None,
        name=request.name,
        start_s=float(flight.time[0]),
    )
    write_plan(request.folder, folder)
    return {
        "report": report,
        "feasible": report["feasible"],
        "refusal": refusal,
        "plan_hash": folder.info.plan_hash,
        "samples": n,
        "duration_s": folder.info.duration_s,
        "lead_in_s": leads[0] / request.rate_hz,
        "lead_out_s": leads[1] / request.rate_hz,
        "resampling": flight.note,
    }


def _leads(solution: Solution, rate_hz: float) -> tuple[Array, Array]:
    """Way in and out, (m, 4) [rad] each, joined to the flight's own rate and acceleration at its ends."""
    dt = 1.0 / rate_hz
    first = end_motion(solution.angles, dt)
    last = end_motion(solution.angles[::-1], -dt)
    return lead_in(solution.rig, *first, dt), lead_out(solution.rig, *last, dt)


def end_motion(angles: Array, dt: float) -> tuple[Array, Array, Array]:
    """Position, rate and acceleration (4,) at the first row of angles (n, 4), by one-sided differences of up to
    fourth order; with -dt and the rows reversed, at the last."""
    x = angles[:5]
    rate_rows = {
        1: [0.0],
        2: [-1, 1],
        3: [-1.5, 2, -0.5],
        4: [-11 / 6, 3, -1.5, 1 / 3],
        5: [-25 / 12, 4, -3, 4 / 3, -0.25],
    }
    acceleration_rows = {
        1: [0.0],
        2: [0.0, 0.0],
        3: [1, -2, 1],
        4: [2, -5, 4, -1],
        5: [35 / 12, -26 / 3, 9.5, -14 / 3, 11 / 12],
    }
    rate = np.array(rate_rows[len(x)]) @ x / dt
    acceleration = np.array(acceleration_rows[len(x)]) @ x / dt**2
    return np.array(x[0]), rate, acceleration


def _margins(at: Array, solution: Solution) -> dict[str, Any]:
    """The wire's `MarginsOut`."""
    found = margins(at, solution.angles, solution.rig)
    kinds = {"position_deg": found.position, "rate_deg_s": found.rate, "acceleration_deg_s2": found.acceleration}

    def margin(value: float, when: float) -> dict[str, float] | None:
        return {"value": value, "time_s": when} if math.isfinite(value) else None

    rows: dict[str, Any] = {
        FRAMES[index]: {
            kind: margin(math.degrees(table[index, 0]), float(table[index, 1])) for kind, table in kinds.items()
        }
        for index in solution.rig.geometry.frames
    }
    return rows | {"singularity": margin(*found.singularity)}


def _whole(angles: Array, request: PlanRequest, lead: int) -> str | None:
    """Why the path, leads included, is not inside the limits; None where it is."""
    at = (np.arange(len(angles)) - lead) / request.rate_hz
    violations = verify(at, angles, request.rig, None).violations
    return None if not violations else f"with its leads: {_sentence(violations[0])}"


def _sentence(violation: Violation) -> str:
    value = math.degrees(violation.value)
    return f"at {violation.time:.3f} s the {violation.frame} frame exceeds its {violation.limit} limit ({value:.4g})"
