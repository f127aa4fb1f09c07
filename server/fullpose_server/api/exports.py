"""Exports that are made to be downloaded."""

import asyncio
from collections.abc import Callable
from pathlib import Path
from uuid import uuid4

from fullpose_server.api.answer_file import AnswerFile
from fullpose_server.api.deps import Services
from fullpose_server.formats.exporters.registry import EXPORTERS, ExportKind


async def exported(services: Services, stem: str, kind: ExportKind, write: Callable[[Path], None]) -> AnswerFile:
    """What `write` writes, as the file `stem` with the ending of its kind."""
    services.disk.check()
    draft = services.uploads / uuid4().hex
    try:
        await asyncio.to_thread(write, draft)
    except BaseException:
        draft.unlink(missing_ok=True)
        raise
    return AnswerFile(draft, media_type=EXPORTERS[kind].media_type, filename=f"{stem}.{kind}")
