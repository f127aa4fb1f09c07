"""Curves of a recorded run: all of it at once, any stretch of it at any width, and it against another run or a plan."""

import asyncio
import struct
from typing import Annotated, Any, Literal

import numpy as np
from fastapi import APIRouter, Query, Response

from fullpose_server.api.deps import Services, ServicesDep
from fullpose_server.api.offload.curves import Other
from fullpose_server.api.openapi import BUSY
from fullpose_server.api.problems import ApiError
from fullpose_server.api.routes.runs import check_flown
from fullpose_server.api.schemas.curves import CurveEvent, CurvesOut, DifferenceOut
from fullpose_server.errors import FileError
from fullpose_server.runtime.recording.against import Difference
from fullpose_server.runtime.recording.curves import About, Curves
from fullpose_server.runtime.recording.mcap_reader import RecordError
from fullpose_server.runtime.recording.pyramid import Buckets
from fullpose_server.runtime.recording.run_index import is_being_written

router = APIRouter(prefix="/runs", tags=["runs"])
MAGIC = 0x31435046  # "FPC1", little-endian
_HEADER = struct.Struct("<IIII")
_NOT_YET: dict[int | str, dict[str, Any]] = {409: {"description": "It is being written, or its curves are being made"}}
_ANSWER: dict[int | str, dict[str, Any]] = {200: {"content": {"application/octet-stream": {}}}}
Against = Annotated[
    str | None,
    Query(description="What to compare with: `run:ID` or `plan:ID`", pattern=r"^(run|plan):[A-Za-z0-9._-]{1,200}$"),
]
Seconds = Annotated[float, Query(ge=-1e9, le=1e9, allow_inf_nan=False, description="After the run's first sample")]
Width = Annotated[int, Query(ge=2, le=4000, description="Buckets wanted, one a pixel, say")]


@router.get(
    "/{run}/curves",
    responses={202: {"model": CurvesOut, "description": "They are being made: ask again"}, **_NOT_YET, **BUSY},
)
async def run_curves(run: str, services: ServicesDep, response: Response, against: Against = None) -> CurvesOut:
    """What there is to draw of a run, and what happened in it. Made of its record when first asked for."""
    await _check(run, services)
    curves = await services.curves.curves(run)
    if isinstance(curves, float):
        response.status_code = 202
        return _making(curves)
    other = await _other(against, services)
    if other is None:
        return _out(curves.about, None)
    difference = await services.curves.difference(run, other)
    if isinstance(difference, float):
        response.status_code = 202
        return _making(difference)
    about = difference.about
    told = DifferenceOut(
        kind="run" if other.kind == "run" else "plan",
        id=other.id,
        aligned=about.aligned,
        columns=about.columns,
        turned_deg=about.turned_deg,
    )
    return _out(curves.about, told)


@router.get("/{run}/curves/window", response_class=Response, responses={**_ANSWER, **_NOT_YET, **BUSY})
async def curves_window(
    run: str, services: ServicesDep, from_s: Seconds, to_s: Seconds, width: Width = 1200, against: Against = None
) -> Response:
    """A window of the curves, or of the difference, as `schemas.curves` describes it: least and greatest by bucket."""
    if not from_s < to_s:
        raise ApiError(422, "validation", f"query.from_s: {from_s:g}: expected less than to_s, {to_s:g}")
    await _check(run, services)
    curves = await services.curves.curves(run)
    other = await _other(against, services)
    difference = None if other is None or isinstance(curves, float) else await services.curves.difference(run, other)
    if isinstance(curves, float) or isinstance(difference, float):
        raise ApiError(409, "not-done", f"the curves of run {run} are being made: ask for them until they are ready")
    body = await asyncio.to_thread(_window, run, curves, difference, (from_s, to_s), width)
    return Response(body, media_type="application/octet-stream")


def _window(run: str, curves: Curves, difference: Difference | None, stretch: tuple[float, float], width: int) -> bytes:
    try:
        if difference is None:
            return _encoded(curves.window(*stretch, width))
        first, last = curves.span(*stretch)
    except RecordError as error:
        raise FileError(f"{run}.mcap", f"a record ({error.why})") from None
    return _encoded(difference.between(first, last, width))


def _encoded(found: Buckets) -> bytes:
    buckets, columns = found.least.shape
    alone = buckets > 0 and int(np.diff(found.edges).max()) == 1
    parts = [found.least] if alone else [found.least, found.greatest]
    values = np.stack(parts, axis=1).transpose(2, 1, 0)  # column by column, least before greatest
    return _HEADER.pack(MAGIC, columns, buckets, alone) + np.ascontiguousarray(values, "<f8").tobytes()


async def _check(run: str, services: Services) -> None:
    path = await asyncio.to_thread(services.runs.path, run)
    check_flown(services, run)
    if await asyncio.to_thread(is_being_written, path):
        raise ApiError(409, "in-use", f"run {run} is being written")


async def _other(against: str | None, services: Services) -> Other | None:
    if against is None:
        return None
    kind, _, name = against.partition(":")
    if kind == "run":
        await _check(name, services)
    else:
        row = await asyncio.to_thread(services.plans.get, name)
        if row.status != "done":
            raise ApiError(409, "not-done", f"plan {name} is {row.status}: it has no samples")
    return Other(kind, name)


def _making(progress: float) -> CurvesOut:
    return CurvesOut(
        ready=False,
        progress=progress,
        samples=0,
        duration_s=0.0,
        started=None,
        record_sha256=None,
        columns=[],
        events=[],
        events_left_out=0,
        against=None,
    )


def _out(about: About, against: DifferenceOut | None) -> CurvesOut:
    gaps = [
        CurveEvent(at_s=at, kind="gap", text=f"{missing} samples are missing", severity=None)
        for at, missing in about.gaps
    ]
    events = [told for event in about.events if (told := _event(event)) is not None]
    return CurvesOut(
        ready=True,
        progress=1.0,
        samples=about.rows,
        duration_s=about.duration_s,
        started=about.started,
        record_sha256=about.sha256,
        columns=about.columns,
        events=sorted([*events, *gaps], key=lambda event: event.at_s),
        events_left_out=about.events_left_out,
        against=against,
    )


_KINDS: dict[str, Literal["command", "alarm", "transition", "begin", "end"]] = {
    "command": "command",
    "alarm": "alarm",
    "transition": "transition",
    "run_begin": "begin",
    "incident": "begin",
    "run_end": "end",
}


def _event(event: dict[str, Any]) -> CurveEvent | None:
    """None for what is of no interest on an axis."""
    kind = _KINDS.get(str(event.get("kind")))
    match kind:
        case None:
            return None
        case "command":
            refused = event.get("refused")
            text = f"{event.get('command')} by {event.get('who') or 'somebody'}" + (
                f": refused, {refused}" if refused else ""
            )
        case "alarm":
            text = str(event.get("message") or event.get("code"))
        case "transition":
            text = f"{event.get('before')} → {event.get('after')}"
        case "begin":
            text = "recording begins"
        case "end":
            text = f"the run ends: {event.get('how') or 'not told'}"
    severity: Literal["fault", "warning"] | None = None
    if kind == "alarm":
        severity = "warning" if event.get("severity") == "warning" else "fault"
    return CurveEvent(at_s=event["at_s"], kind=kind, text=text, severity=severity)
