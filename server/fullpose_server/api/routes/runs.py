"""Recorded runs: list, detail, evidence."""

import asyncio
from datetime import UTC, datetime
from functools import partial
from typing import Any
from uuid import uuid4

from fastapi import APIRouter, Request
from pydantic import TypeAdapter
from starlette.responses import FileResponse, Response

from fullpose_server.api.answer_file import AnswerFile
from fullpose_server.api.changes import CHANGE
from fullpose_server.api.deps import Services, ServicesDep
from fullpose_server.api.labels import WantedDep, changed
from fullpose_server.api.openapi import BUSY
from fullpose_server.api.paging import LINKED, PageDep
from fullpose_server.api.problems import ApiError
from fullpose_server.api.schemas.labels import LabelsIn
from fullpose_server.api.schemas.records import RunOut
from fullpose_server.formats.labels import Wanted
from fullpose_server.runtime.recording.run_index import RunInUseError
from fullpose_server.runtime.recording.run_search import Sought
from fullpose_server.runtime.recording.run_summary import RunSummary
from fullpose_server.session.run_end import RunEnd
from fullpose_server.store.keyset import Key

router = APIRouter(prefix="/runs", tags=["runs"])
_LIST = TypeAdapter(list[RunOut])
_IN_USE: dict[int | str, dict[str, Any]] = {409: {"description": "It is pinned, or being written"}}
_ENDS = {str(end): end for end in RunEnd}


@router.get("", response_model=list[RunOut], responses=LINKED)
def list_runs(
    request: Request, services: ServicesDep, page: PageDep, wanted: WantedDep, rig: str | None = None
) -> Response:
    """Runs and incidents, newest first, a page at a time; a record that cannot be read is listed with its error.

    Searched for by id, rig, who flew it, how it ended, notes and tags, and by what is their plan's or its flight's.
    """
    before = None if page.before is None else page.before.id
    found = services.runs.all(rig, before, page.wanted, _sought(services, wanted))
    runs = page.cut(found)
    last = Key(runs[-1].started or 0.0, runs[-1].id) if runs else None
    return page.answer(request, _LIST.dump_json([_out(services, run) for run in runs]), len(found), last)


def _sought(services: Services, wanted: Wanted) -> Sought | None:
    """None where nothing is searched for."""
    if not wanted.parts:
        return None
    return tuple((part, partial(services.plans.of_wanted, part)) for part in wanted.parts)


@router.patch("/{run}", dependencies=CHANGE)
def label_run(run: str, body: LabelsIn, services: ServicesDep) -> RunOut:
    """Put tags and notes to a run; its record stays as it is."""
    found = services.runs.get(run)
    before = services.runs.labels.get(run)
    services.runs.labels.put(run, changed(body, before.tags, before.notes))
    return _out(services, found)


@router.get("/{run}")
def get_run(run: str, services: ServicesDep) -> RunOut:
    """One run."""
    return _out(services, services.runs.get(run))


@router.get(
    "/{run}/evidence",
    response_class=FileResponse,
    responses={200: {"content": {"application/zip": {}}}, 409: {"description": "It is being written"}, **BUSY},
)
async def run_evidence(run: str, services: ServicesDep) -> FileResponse:
    """Everything that the run was as one signed file, which `fullpose evidence verify` proves without this server."""
    services.runs.path(run)
    check_flown(services, run)
    services.disk.check()
    await asyncio.to_thread(_all_written, services)
    draft = services.uploads / uuid4().hex
    try:
        await services.evidence.make(run, draft)
    except BaseException:
        draft.unlink(missing_ok=True)
        raise
    return AnswerFile(draft, media_type="application/zip", filename=f"{run}.zip")


def check_flown(services: Services, run: str) -> None:
    """Raise `ApiError` while a run is being flown."""
    for host in services.hosts.all():
        if host.snapshot().run_id == run:
            raise ApiError(409, "in-use", f"run {run} is being flown on rig {host.name}")


def _all_written(services: Services) -> None:
    """Audit and alarms as of now are in the database."""
    services.trail.written()
    services.alarm_trail.written()


@router.delete("/{run}", status_code=204, responses=_IN_USE, dependencies=CHANGE)
async def remove_run(run: str, services: ServicesDep) -> None:
    """Remove a run that is neither pinned nor being written."""
    check_flown(services, run)
    try:
        await asyncio.to_thread(services.runs.remove, run)
        await asyncio.to_thread(services.curves.forget, run)
    except RunInUseError as error:
        raise ApiError(409, "in-use", str(error)) from None


@router.put("/{run}/pin", status_code=204, dependencies=CHANGE)
def pin_run(run: str, services: ServicesDep) -> None:
    """Keep a run: retention passes it over, and it cannot be deleted."""
    services.runs.pin(run, pinned=True)


@router.delete("/{run}/pin", status_code=204, dependencies=CHANGE)
def unpin_run(run: str, services: ServicesDep) -> None:
    """Keep it no longer than any other."""
    services.runs.pin(run, pinned=False)


def _out(services: Services, run: RunSummary) -> RunOut:
    labels = services.runs.labels.get(run.id)
    return RunOut(
        tags=list(labels.tags),
        notes=labels.notes,
        pinned=services.runs.pinned(run.id),
        id=run.id,
        rig=run.rig,
        end=_ENDS.get(run.end or ""),
        end_code=run.end_code,
        incident=run.incident,
        error=run.error,
        plan_id=run.plan_id,
        plan_hash=run.plan_hash,
        who=run.who,
        started_at=_time(run.started),
        ended_at=_time(run.ended),
        duration_s=None if run.started is None or run.ended is None else run.ended - run.started,
        samples=run.samples,
        lost_samples=run.lost_samples,
        bytes=run.bytes,
        complete=run.complete,
        max_solve_error_deg=run.max_solve_error_deg,
        max_tracking_error_deg=run.max_tracking_error_deg,
        max_lateness_us=run.max_lateness_us,
    )


def _time(seconds: float | None) -> datetime | None:
    return None if seconds is None else datetime.fromtimestamp(seconds, UTC)
