"""Files that are made to be downloaded, and are gone once their last byte is sent."""

import asyncio
from collections.abc import Callable
from pathlib import Path
from uuid import uuid4

from starlette.background import BackgroundTask
from starlette.responses import FileResponse

from fullpose_server.api.deps import Services
from fullpose_server.formats.exporters.registry import EXPORTERS, ExportKind


async def exported(services: Services, stem: str, kind: ExportKind, write: Callable[[Path], None]) -> FileResponse:
    """What `write` writes, as the file `stem` with the ending of its kind."""
    services.disk.check()
    draft = services.uploads / uuid4().hex
    try:
        await asyncio.to_thread(write, draft)
    except BaseException:
        draft.unlink(missing_ok=True)
        raise
    done = BackgroundTask(draft.unlink, missing_ok=True)
    return FileResponse(draft, media_type=EXPORTERS[kind].media_type, filename=f"{stem}.{kind}", background=done)
