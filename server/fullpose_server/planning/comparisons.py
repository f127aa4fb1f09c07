"""Comparisons as jobs: each a folder comparisons/<id>/ with its request, report and page, made by a process of its own.

The folder is the whole record, so nothing is in the database: what has a report is done, what has only a request when
the server starts was interrupted. One comparison is made at a time.
"""

import asyncio
import contextlib
import json
import logging
import re
import shutil
import sys
from collections.abc import Sequence
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Any, Literal
from uuid import uuid4

from fullpose.registry import Variant
from fullpose.rig import FrameLimits, Geometry, Rig
from fullpose_server.errors import NotFoundError

log = logging.getLogger(__name__)
Status = Literal["queued", "running", "done", "failed", "cancelled", "interrupted"]
REQUEST, REPORT, PAGE, ERROR = "request.json", "report.json", "page.html", "error.json"
UNFINISHED = ("queued", "running")
_ID = re.compile(r"[0-9a-f]{16}")


@dataclass(frozen=True)
class CompareRequest:
    """All that the comparing process is told; JSON in the job's folder."""

    trajectory_sha256: str
    trajectory: str  # folder of the flight's arrays
    name: str
    rig: Rig
    methods: tuple[Variant, ...]
    rate_hz: float
    start: tuple[float, float, float, float] | None  # [rad]
    created: float  # [s] since the epoch

    def to_json(self) -> str:
        """Infinities stay infinities."""
        return json.dumps(asdict(self))

    @classmethod
    def from_json(cls, text: str) -> "CompareRequest":
        """The inverse of `to_json`."""
        values = json.loads(text)
        rig = values["rig"]
        base, outer, middle, inner = (FrameLimits(**frame) for frame in rig["frames"])
        start = values["start"]
        return cls(
            **{
                **values,
                "rig": Rig(rig["name"], Geometry(rig["geometry"]), (base, outer, middle, inner)),
                "methods": tuple(_variant(method) for method in values["methods"]),
                "start": None if start is None else tuple(start),
            }
        )


def _variant(value: str | dict[str, Any]) -> Variant:
    return Variant(value, value) if isinstance(value, str) else Variant(**value)  # earlier servers kept names alone


@dataclass
class Comparison:
    """One job as it stands now."""

    id: str
    request: CompareRequest
    status: Status
    error: dict[str, str] | None = None
    progress: tuple[str, int, int] = ("", 0, 1)  # label, samples done, samples of all methods
    task: asyncio.Task[None] | None = field(default=None, repr=False)


class Comparisons:
    """The jobs. Use it from one event loop; `close` ends what runs."""

    def __init__(self, root: Path) -> None:
        self._root = root
        root.mkdir(parents=True, exist_ok=True)
        self._turn = asyncio.Lock()
        self._jobs = {job.id: job for path in sorted(root.iterdir()) if (job := _found(path)) is not None}

    def submit(self, request: CompareRequest) -> Comparison:
        """A new comparison, queued."""
        job = Comparison(uuid4().hex[:16], request, "queued")
        folder = self.folder(job.id)
        folder.mkdir()
        (folder / REQUEST).write_text(request.to_json(), encoding="utf-8")
        self._jobs[job.id] = job
        job.task = asyncio.create_task(self._run(job), name=f"comparison {job.id}")
        return job

    def get(self, comparison: str) -> Comparison:
        """Raises `NotFoundError`."""
        if comparison not in self._jobs:
            raise NotFoundError("comparison", comparison)
        return self._jobs[comparison]

    def all(self) -> Sequence[Comparison]:
        """Newest first."""
        return sorted(self._jobs.values(), key=lambda job: -job.request.created)

    def report(self, comparison: str) -> dict[str, Any] | None:
        """The report of a finished comparison. Raises `NotFoundError`."""
        if self.get(comparison).status != "done":
            return None
        report: dict[str, Any] = json.loads((self.folder(comparison) / REPORT).read_text(encoding="utf-8"))
        for method in report["methods"]:
            method.setdefault("label", method["method"])  # earlier servers compared each method once
        return report

    def folder(self, comparison: str) -> Path:
        """Where its files are."""
        return self._root / comparison

    async def remove(self, comparison: str) -> None:
        """Cancel a comparison that is being made (it stays, cancelled); remove one that is not."""
        job = self.get(comparison)
        if job.status in UNFINISHED and job.task is not None:
            await self._end(job, "cancelled", "cancelled before it was done")
            return
        del self._jobs[comparison]
        await asyncio.to_thread(shutil.rmtree, self.folder(comparison))

    async def close(self) -> None:
        """End what runs; it is marked interrupted."""
        for job in self._jobs.values():
            if job.status in UNFINISHED:
                await self._end(job, "interrupted", "the server ended while this comparison was being made")

    async def _end(self, job: Comparison, status: Status, message: str) -> None:
        if job.task is not None:
            job.task.cancel()
            await asyncio.gather(job.task, return_exceptions=True)
        if job.status in UNFINISHED:  # it may have finished in the meantime
            self._fail(job, status, status, message)

    async def _run(self, job: Comparison) -> None:
        async with self._turn:
            job.status = "running"
            process = await asyncio.create_subprocess_exec(
                sys.executable,
                "-m",
                "fullpose_server.planning.compare_worker",
                str(self.folder(job.id)),
                stdin=asyncio.subprocess.PIPE,  # it ends when this does, so it never outlives the server
                stdout=asyncio.subprocess.PIPE,
                start_new_session=True,
            )
            try:
                assert process.stdout is not None
                error: dict[str, str] | None = None
                while line := await process.stdout.readline():
                    message: dict[str, Any] = json.loads(line)
                    error = message.get("failed", error)
                    if "progress" in message:
                        label, done, total = message["progress"]
                        job.progress = (label, done, total)
                code = await process.wait()
            finally:
                with contextlib.suppress(ProcessLookupError):
                    process.kill()
                await process.wait()
        if code == 0 and error is None:
            job.status = "done"
        else:
            ended = error or {"code": "ended", "message": f"the comparing process ended with status {code}"}
            log.warning("comparison %s: %s", job.id, ended["message"])
            self._fail(job, "failed", ended["code"], ended["message"])

    def _fail(self, job: Comparison, status: Status, code: str, message: str) -> None:
        job.status, job.error = status, {"code": code, "message": message}
        (self.folder(job.id) / ERROR).write_text(json.dumps({"status": status, **job.error}), encoding="utf-8")


def _found(folder: Path) -> Comparison | None:
    """The job of a folder that an earlier server left; None where it is no job's."""
    if not _ID.fullmatch(folder.name) or not (folder / REQUEST).is_file():
        return None
    request = CompareRequest.from_json((folder / REQUEST).read_text(encoding="utf-8"))
    if (folder / REPORT).is_file():
        return Comparison(folder.name, request, "done")
    if (folder / ERROR).is_file():
        error = json.loads((folder / ERROR).read_text(encoding="utf-8"))
        status: Status = error.pop("status")
        return Comparison(folder.name, request, status, error)
    error = {"code": "interrupted", "message": "the server ended while this comparison was being made"}
    return Comparison(folder.name, request, "interrupted", error)
