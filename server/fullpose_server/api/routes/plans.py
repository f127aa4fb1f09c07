"""Plans: jobs that bring a flight onto a rig."""

import asyncio
import math
from datetime import UTC, datetime
from typing import Annotated, Any

import numpy as np
from fastapi import APIRouter, Query, Request, Response
from pydantic import TypeAdapter

from fullpose.registry import DEFAULT, REGISTRY, method_options, option_defaults
from fullpose.rig import FRAMES
from fullpose_server.api.changes import CHANGE
from fullpose_server.api.deps import Services, ServicesDep, WhoDep
from fullpose_server.api.labels import WantedDep, changed
from fullpose_server.api.openapi import BUSY
from fullpose_server.api.paging import LINKED, PageDep
from fullpose_server.api.problems import ApiError
from fullpose_server.api.progress import progress_out
from fullpose_server.api.quotas import check_span, queue_slot
from fullpose_server.api.schemas.labels import LabelsIn
from fullpose_server.api.schemas.plans import (
    JobErrorOut,
    MethodOut,
    PlanIn,
    PlanOut,
    PlanSamples,
    ReportOut,
)
from fullpose_server.api.schemas.remedies import RemedyChange, RemedyIn, RemedyOut
from fullpose_server.errors import TransitionError
from fullpose_server.formats.plan_folder import rig_hash
from fullpose_server.formats.start_pose import start_pose
from fullpose_server.pages.thin import thin
from fullpose_server.planning.plan_request import check_frame
from fullpose_server.planning.plan_result import refusal_of
from fullpose_server.planning.scrub import open_plan
from fullpose_server.store.jobs import JobStatus
from fullpose_server.store.keyset import Key
from fullpose_server.store.plans import PlanAsked
from fullpose_server.store.tables import PlanRow

router = APIRouter(tags=["plans"])
_LIST = TypeAdapter(list[PlanOut])


@router.get("/methods")
def list_methods() -> list[MethodOut]:
    """The methods that plans, solves and comparisons may name."""
    return [
        MethodOut(name=m.name, source=m.source, claims_limits=m.claims_limits, options=option_defaults(m.name))
        for m in REGISTRY.values()
    ]


@router.post("/plans", status_code=202, responses=BUSY, dependencies=CHANGE)
async def add_plan(body: PlanIn, response: Response, services: ServicesDep, who: WhoDep) -> PlanOut:
    """Ask for a plan; poll it until its status is done, failed or cancelled."""
    services.disk.check()
    with queue_slot(services.queue.pending, who, services.settings):
        entry = await asyncio.to_thread(services.rigs.get, body.rig)
        method_options(body.method, dict(body.options))
        flight = await asyncio.to_thread(services.trajectories.get, body.trajectory)
        check_span(flight.duration_s, services.settings)
        if body.start_deg is not None:
            start_pose(body.start_deg, entry.rig, "start_deg")
        row = await asyncio.to_thread(
            services.plans.add,
            PlanAsked(
                trajectory=body.trajectory,
                rig=body.rig,
                rig_hash=rig_hash(entry.rig),
                method=body.method,
                options=dict(body.options),
                start_deg=None if body.start_deg is None else list(body.start_deg),
                tolerance_deg=body.tolerance_deg,
                rate_hz=services.settings.rig_rate_hz,
            ),
        )
        services.queue.submit(row.id, who)
        response.headers["Location"] = f"/api/v1/plans/{row.id}"
        return await asyncio.to_thread(_out, services, row)


@router.get("/plans", response_model=list[PlanOut], responses=LINKED)
def list_plans(
    request: Request,
    services: ServicesDep,
    page: PageDep,
    wanted: WantedDep,
    trajectory: str | None = None,
    rig: str | None = None,
) -> Response:
    """Plans, newest first, a page at a time; all, or those that are searched for, by what is their flight's too."""
    found = services.plans.all(trajectory, rig, page.before, page.wanted, wanted)
    rows = page.cut(found)
    last = Key(rows[-1][0].created, rows[-1][0].id) if rows else None
    return page.answer(request, _LIST.dump_json([_out(services, *row) for row in rows]), len(found), last)


@router.get("/plans/{plan}")
def get_plan(plan: str, services: ServicesDep) -> PlanOut:
    """One plan and how far it is."""
    return _out(services, services.plans.get(plan))


@router.patch("/plans/{plan}", dependencies=CHANGE)
def label_plan(plan: str, body: LabelsIn, services: ServicesDep) -> PlanOut:
    """Put tags and notes to a plan; its hash, and what it flies, stay as they are."""
    row = services.plans.get(plan)
    return _out(services, services.plans.label(plan, changed(body, row.tags, row.notes)))


@router.post("/plans/{plan}/remedies", status_code=202, responses=BUSY, dependencies=CHANGE)
async def add_remedy(plan: str, body: RemedyIn, response: Response, services: ServicesDep, who: WhoDep) -> PlanOut:
    """Search what would make this plan's flight fit its rig: a plan of its own, with progress and cancel as any other.

    It is planned with method plan. What was changed is in its `remedy`; it can be loaded like the rest, but for a
    relaxed limit, which the rig must be given first.
    """
    services.disk.check()
    with queue_slot(services.queue.pending, who, services.settings):
        of = await asyncio.to_thread(services.plans.get, plan)
        entry = await asyncio.to_thread(services.rigs.get, of.rig)
        check_frame(body.frame, entry.rig)
        row = await asyncio.to_thread(
            services.plans.add,
            PlanAsked(
                trajectory=of.trajectory,
                rig=of.rig,
                rig_hash=rig_hash(entry.rig),
                method=DEFAULT,  # every trial of a remedy is the planner's
                options=of.options if of.method == DEFAULT else {},
                start_deg=of.start_deg,
                tolerance_deg=of.tolerance_deg,
                rate_hz=services.settings.rig_rate_hz,
                remedy={"of": plan, **body.model_dump()},
            ),
        )
        services.queue.submit(row.id, who)
        response.headers["Location"] = f"/api/v1/plans/{row.id}"
        return await asyncio.to_thread(_out, services, row)


@router.get("/plans/{plan}/samples", responses={409: {"description": "The plan is not done"}})
def plan_samples(
    plan: str, services: ServicesDep, points: Annotated[int, Query(ge=2, le=20_000)] = 2000
) -> PlanSamples:
    """Angles, rates, accelerations and error of a plan, thinned to about `points` samples, for plots."""
    row = services.plans.get(plan)
    if row.status != JobStatus.DONE:
        raise ApiError(409, "not-done", f"plan {plan} is {row.status}: it has no samples")
    return _samples(plan, services, points)


@router.delete(
    "/plans/{plan}",
    status_code=204,
    responses={409: {"description": "A session has loaded it"}},
    dependencies=CHANGE,
)
async def remove_plan(plan: str, services: ServicesDep) -> None:
    """Cancel a plan that is being made (it stays, cancelled); remove one that is not."""
    row = await asyncio.to_thread(services.plans.get, plan)
    try:
        if not JobStatus(row.status).finished:
            await services.queue.cancel(plan)
            return
        for host in services.hosts.all():
            bound = host.snapshot().plan
            if bound is not None and bound.plan_id == plan:
                raise ApiError(409, "in-use", f"plan {plan} is loaded on rig {host.name}: unload it first")
        await asyncio.to_thread(services.plans.remove, plan)
    except TransitionError as error:
        raise ApiError(409, "job-status", str(error)) from None


def _out(services: Services, row: PlanRow, name: str | None = None) -> PlanOut:
    name = services.trajectories.get(row.trajectory).name if name is None else name
    result: dict[str, Any] = row.result or {}
    refusal = refusal_of(result)
    return PlanOut.model_validate(
        {
            "id": row.id,
            "status": row.status,
            "progress": progress_out(JobStatus(row.status), services.queue.progress(row.id)),
            "trajectory": row.trajectory,
            "trajectory_name": name,
            "rig": row.rig,
            "rig_hash": row.rig_hash,
            "method": row.method,
            "options": row.options,
            "start_deg": row.start_deg,
            "tolerance_deg": row.tolerance_deg,
            "created_at": _time(row.created),
            "started_at": _time(row.started),
            "finished_at": _time(row.finished),
            "error": None if row.error is None else JobErrorOut(**row.error),
            "feasible": result.get("feasible"),
            "flyable": row.status == JobStatus.DONE and refusal is None,
            "refusal": refusal,
            "plan_hash": result.get("plan_hash"),
            "rate_hz": row.rate_hz,
            "resampling": result.get("resampling"),
            "samples": result.get("samples"),
            "duration_s": result.get("duration_s"),
            "lead_in_s": result.get("lead_in_s"),
            "lead_out_s": result.get("lead_out_s"),
            "report": ReportOut(**result["report"]) if result else None,
            "verdict": result.get("verdict"),
            "margins": result.get("margins"),
            "tags": row.tags,
            "notes": row.notes,
            "remedy": None if row.remedy is None else _remedy(row.remedy, result.get("remedy") or {}),
        }
    )


def _remedy(asked: dict[str, Any], found: dict[str, Any]) -> RemedyOut:
    change = {name: found.get(name) for name in RemedyChange.model_fields} if found else None
    return RemedyOut.model_validate(
        {
            **asked,
            "change": change,
            "sufficient": found.get("sufficient"),
            "alternatives": found.get("alternatives", []),
        }
    )


def _samples(plan: str, services: Services, points: int) -> PlanSamples:
    stored = open_plan(plan, services.plans, services.quarantine)
    info = stored.info
    dt = 1.0 / info.rate_hz
    angles = np.rad2deg(stored.angles)
    rates = np.gradient(angles, dt, axis=0) if len(angles) > 1 else np.zeros_like(angles)
    accelerations = np.gradient(rates, dt, axis=0) if len(angles) > 1 else np.zeros_like(angles)
    jerks = np.gradient(accelerations, dt, axis=0) if len(angles) > 1 else np.zeros_like(angles)
    error = np.rad2deg(stored.error)
    rows = thin(info.samples, points, angles, rates, error)
    time_s = (rows - info.lead_in_samples) * dt

    def frames(table: Any) -> dict[str, list[float]]:
        return {name: table[rows, index].tolist() for index, name in enumerate(FRAMES)}

    return PlanSamples.model_validate(
        {
            "id": plan,
            "samples": info.samples,
            "time_s": time_s.tolist(),
            "angles_deg": frames(angles),
            "rates_deg_s": frames(rates),
            "accelerations_deg_s2": frames(accelerations),
            "jerks_deg_s3": frames(jerks),
            "error_deg": [value if math.isfinite(value) else None for value in error[rows].tolist()],
            "q": [q if math.isfinite(q[0]) else None for q in stored.target[rows].tolist()],
            "lead_in_s": info.lead_in_samples * dt,
            "lead_out_s": info.lead_out_samples * dt,
        }
    )


def _time(seconds: float | None) -> datetime | None:
    return None if seconds is None else datetime.fromtimestamp(seconds, UTC)
