"""Answers that are made as a file: gone once the last byte is sent, or nobody takes them any more."""

import asyncio
from pathlib import Path

from starlette.responses import FileResponse
from starlette.types import Receive, Scope, Send

from fullpose_server.api.deps import Services
from fullpose_server.api.offload.work import Request, Work


class AnswerFile(FileResponse):
    """A file that is there for this answer alone."""

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Send it."""
        try:
            await super().__call__(scope, receive, send)
        finally:  # a background task would not be run where the client has left
            await asyncio.to_thread(Path(self.path).unlink, missing_ok=True)


async def answered(services: Services, work: Work, asked: Request, answer: Path) -> AnswerFile:
    """The JSON that a worker writes to `answer`. Raises what `offload.run` does; then the file is gone."""
    try:
        await services.offload.run(work, asked.to_json())
    except BaseException:
        await asyncio.to_thread(answer.unlink, missing_ok=True)
        raise
    return AnswerFile(answer, media_type="application/json")
