"""Comparisons: jobs that put methods side by side on one flight and rig."""

import asyncio
import time
from datetime import UTC, datetime

from fastapi import APIRouter, Request, Response
from pydantic import TypeAdapter
from starlette.responses import FileResponse

from fullpose.compare import variants
from fullpose.registry import Variant, parse_variant, variant
from fullpose_server.api.changes import CHANGE
from fullpose_server.api.deps import Services, ServicesDep, WhoDep
from fullpose_server.api.openapi import BUSY
from fullpose_server.api.paging import LINKED, PageDep
from fullpose_server.api.problems import ApiError
from fullpose_server.api.progress import progress_out
from fullpose_server.api.quotas import check_span, queue_slot
from fullpose_server.api.schemas.compare import CompareIn, ComparisonOut, ComparisonReportOut, MethodIn
from fullpose_server.formats.start_pose import start_pose
from fullpose_server.planning.compare_length import check_length
from fullpose_server.planning.compare_request import PAGE, CompareRequest
from fullpose_server.planning.comparisons import Comparison
from fullpose_server.store.jobs import JobStatus
from fullpose_server.store.keyset import Key

router = APIRouter(prefix="/compare", tags=["compare"])
_LIST = TypeAdapter(list[ComparisonOut])


@router.post("", status_code=202, responses=BUSY, dependencies=CHANGE)
async def add_comparison(body: CompareIn, response: Response, services: ServicesDep, who: WhoDep) -> ComparisonOut:
    """Ask for a comparison at the rig's own rate; poll it until its status is done, failed or cancelled."""
    services.disk.check()
    with queue_slot(services.comparisons.pending, who, services.settings):
        asked = variants([_variant(method) for method in body.methods])
        entry = await asyncio.to_thread(services.rigs.get, body.rig)
        trajectory = await asyncio.to_thread(services.trajectories.get, body.trajectory)
        rate_hz = services.settings.rig_rate_hz
        check_length(trajectory.duration_s, rate_hz, len(asked))
        check_span(trajectory.duration_s, services.settings)
        start = None if body.start_deg is None else start_pose(body.start_deg, entry.rig, "start_deg")
        request = CompareRequest(
            trajectory_sha256=body.trajectory,
            trajectory=str(services.trajectories.folder(body.trajectory)),
            name=trajectory.name,
            rig=entry.rig,
            methods=asked,
            rate_hz=rate_hz,
            start=start,
            created=time.time(),
            tolerance_deg=body.tolerance_deg,
        )
        job = await services.comparisons.submit(request, who)
        response.headers["Location"] = f"/api/v1/compare/{job.id}"
        return _out(services, job)


@router.get("", response_model=list[ComparisonOut], responses=LINKED)
async def list_comparisons(request: Request, services: ServicesDep, page: PageDep) -> Response:
    """Comparisons, newest first, a page at a time, without their reports."""
    found = services.comparisons.all(page.before, page.wanted)
    jobs = page.cut(found)
    last = Key(jobs[-1].request.created, jobs[-1].id) if jobs else None
    return page.answer(request, _LIST.dump_json([_out(services, job) for job in jobs]), len(found), last)


@router.get("/{comparison}", response_model=ComparisonOut)
async def get_comparison(comparison: str, services: ServicesDep) -> Response:
    """One comparison, how far it is, and its report once it is done."""
    known = _out(services, services.comparisons.get(comparison))
    # The report is read, checked and written in a thread: of many methods it is large.
    return Response(await asyncio.to_thread(_with_report, services, known), media_type="application/json")


@router.get(
    "/{comparison}/page",
    response_class=FileResponse,
    responses={200: {"content": {"text/html": {}}}, 409: {"description": "The comparison is not done"}},
)
async def comparison_page(comparison: str, services: ServicesDep) -> FileResponse:
    """Table and plots as one self-contained HTML page."""
    job = services.comparisons.get(comparison)
    if job.status is not JobStatus.DONE:
        raise ApiError(409, "not-done", f"comparison {comparison} is {job.status}: it has no page")
    return FileResponse(job.folder / PAGE, media_type="text/html; charset=utf-8")


@router.delete("/{comparison}", status_code=204, dependencies=CHANGE)
async def remove_comparison(comparison: str, services: ServicesDep) -> None:
    """Cancel a comparison that is being made (it stays, cancelled); remove one that is not."""
    await services.comparisons.remove(comparison)


def _variant(method: str | MethodIn) -> Variant:
    if isinstance(method, str):
        return parse_variant(method)
    return variant(method.method, method.options, method.label)


def _with_report(services: Services, known: ComparisonOut) -> bytes:
    report = services.comparisons.report(known.id) if known.status is JobStatus.DONE else None
    checked = None if report is None else ComparisonReportOut.model_validate(report)
    return known.model_copy(update={"report": checked}).model_dump_json(by_alias=True).encode()


def _out(services: Services, job: Comparison) -> ComparisonOut:
    return ComparisonOut.model_validate(
        {
            "id": job.id,
            "status": job.status,
            "progress": progress_out(job.status, services.comparisons.progress(job.id)),
            "trajectory": job.request.trajectory_sha256,
            "trajectory_name": job.request.name,
            "rig": job.request.rig.name,
            "methods": [one.label for one in job.request.methods],
            "rate_hz": job.request.rate_hz,
            "created_at": datetime.fromtimestamp(job.request.created, UTC),
            "error": job.error,
            "page": f"/api/v1/compare/{job.id}/page" if job.status is JobStatus.DONE else None,
            "report": None,
        }
    )
