"""Looking at a file before it is stored: what its columns are taken for, and the flight that makes."""

from typing import Annotated
from uuid import uuid4

from fastapi import APIRouter, Query, Request
from starlette.responses import FileResponse

from fullpose_server.api.answer_file import answered
from fullpose_server.api.changes import CHANGE
from fullpose_server.api.deps import ServicesDep
from fullpose_server.api.offload.work import PreviewRequest, Work
from fullpose_server.api.openapi import BUSY
from fullpose_server.api.reading import READING_FIELDS, reading_options
from fullpose_server.api.schemas.trajectories import ReadingPreview
from fullpose_server.api.uploads import FORM, announced, receive_form

router = APIRouter(tags=["trajectories"])
_FORM = {
    "type": "object",
    "required": ["file"],
    "properties": {"file": {"type": "string", "format": "binary"}, **READING_FIELDS},
}
_BODY = {"requestBody": {"required": True, "content": {FORM: {"schema": _FORM}}}}


@router.post("/reading", response_model=ReadingPreview, openapi_extra=_BODY, dependencies=CHANGE, responses=BUSY)
async def read_file(
    request: Request, services: ServicesDep, points: Annotated[int, Query(ge=2, le=20_000)] = 500
) -> FileResponse:
    """Look at a file and store nothing: its first rows, what its columns are taken for, and the flight that makes."""
    settings = services.settings
    services.disk.check(announced(request))
    source, answer = services.uploads / uuid4().hex, services.uploads / uuid4().hex
    try:
        upload = await receive_form(request, source, settings.max_upload_bytes)
        asked = PreviewRequest(
            source=str(source),
            folder=str(answer),
            rows=settings.max_upload_rows,
            columns=settings.max_upload_columns,
            bytes=settings.max_upload_bytes,
            file=upload.filename or "upload",
            how=reading_options(upload.fields, services.profiles),
            points=points,
            profiles=str(services.profiles.folder),
        )
        return await answered(services, Work.PREVIEW, asked, answer)
    finally:
        source.unlink(missing_ok=True)
