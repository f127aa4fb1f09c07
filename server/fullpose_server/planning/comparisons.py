"""Comparisons as jobs: each a folder comparisons/<id>/ with its request, report and page, made by a runner.

The folder is the whole record, so nothing is in the database: what has a report is done, what has only a request when
the server starts was interrupted. One comparison is made at a time.
"""

import asyncio
import contextlib
import json
import re
import shutil
from bisect import bisect_left, insort
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any
from uuid import uuid4

from fullpose.errors import SolverError
from fullpose_server.errors import DamagedError, NotFoundError, TransitionError
from fullpose_server.formats.output_file import write_text
from fullpose_server.planning.compare_request import ERROR, REPORT, REQUEST, CompareRequest, read_request
from fullpose_server.planning.job import Kind, Outcome, Progress
from fullpose_server.planning.runner import Pending, Runner, RunnerStatus
from fullpose_server.store.jobs import JobStatus
from fullpose_server.store.keyset import Key
from fullpose_server.store.quarantine import Quarantine

_ID = re.compile(r"[0-9a-f]{16}")


class Comparison:
    """One comparison, its request, and how it stands; a `Job`."""

    kind = Kind.COMPARISON

    def __init__(
        self, folder: Path, request: CompareRequest, status: JobStatus, error: Mapping[str, str] | None = None
    ) -> None:
        self.id = folder.name
        self.folder = folder
        self.request = request
        self._status = status
        self._error = error

    @property
    def status(self) -> JobStatus:
        """As it stands now."""
        return self._status

    @property
    def error(self) -> Mapping[str, str] | None:
        """Why it is not done, where it ended otherwise."""
        return self._error

    def begin(self) -> Mapping[str, Any] | None:
        """It runs, unless it was cancelled before."""
        if self._status is not JobStatus.QUEUED:
            return None
        self._status = JobStatus.RUNNING
        return {"folder": str(self.folder)}

    def finish(self, outcome: Outcome) -> None:
        """How it ended, kept in its folder. Raises `TransitionError` where it has ended."""
        if self._status.finished:
            raise TransitionError(f"comparison {self.id} is {self._status}: it cannot be {outcome.status}")
        self._status, self._error = outcome.status, outcome.error
        if outcome.error is not None:
            write_text(self.folder / ERROR, json.dumps({"status": outcome.status, **outcome.error}))


class Comparisons:
    """The comparisons. Use it from one event loop; `close` ends what runs."""

    def __init__(self, root: Path, quarantine: Quarantine) -> None:
        self._root = root
        root.mkdir(parents=True, exist_ok=True)
        self._jobs: dict[str, Comparison] = {}
        for path in sorted(root.iterdir()):
            try:
                job = _found(path)
            except (ValueError, KeyError, TypeError, AttributeError, OSError, SolverError) as error:
                quarantine.take("comparison", path.name, [path], f"{type(error).__name__}: {error}")
                continue
            if job is not None:
                self._jobs[job.id] = job
        self._order = sorted(map(_key, self._jobs.values()))
        self._runner = Runner("comparisons", prewarm=False)

    @property
    def status(self) -> RunnerStatus:
        """What the comparing process does."""
        return self._runner.status

    def start(self) -> None:
        """Begin to take comparisons."""
        self._runner.start()

    @property
    def pending(self) -> Pending:
        """What waits or is in work."""
        return self._runner.pending

    async def submit(self, request: CompareRequest, owner: str = "") -> Comparison:
        """A new comparison, queued; `owner` is who asked for it."""
        job = Comparison(self._root / uuid4().hex[:16], request, JobStatus.QUEUED)
        await asyncio.to_thread(_write_request, job)
        self._jobs[job.id] = job
        insort(self._order, _key(job))
        self._runner.submit(job, owner)
        return job

    def get(self, comparison: str) -> Comparison:
        """Raises `NotFoundError`."""
        if comparison not in self._jobs:
            raise NotFoundError("comparison", comparison)
        return self._jobs[comparison]

    def all(self, before: Key | None = None, limit: int | None = None) -> Sequence[Comparison]:
        """Newest first, those after the one at `before`, at most `limit`."""
        end = len(self._order) if before is None else bisect_left(self._order, before)
        begin = 0 if limit is None else max(0, end - limit)
        return [self._jobs[key.id] for key in reversed(self._order[begin:end])]

    def progress(self, comparison: str) -> Progress | None:
        """Of one that is being made."""
        return self._runner.progress(comparison)

    def report(self, comparison: str) -> dict[str, Any] | None:
        """The report of a finished comparison, read from its folder: call it in a thread. Raises `NotFoundError`."""
        job = self.get(comparison)
        if job.status is not JobStatus.DONE:
            return None
        try:
            report: dict[str, Any] = json.loads((job.folder / REPORT).read_text(encoding="utf-8"))
        except (OSError, ValueError) as error:
            raise DamagedError(f"the report of comparison {comparison} is damaged ({error})") from None
        for method in report["methods"]:
            method.setdefault("label", method["method"])  # earlier servers compared each method once
        return report

    def done(self) -> list[Comparison]:
        """Those that have been made."""
        return [job for job in self._jobs.values() if job.status is JobStatus.DONE]

    def damaged(self, comparison: str, quarantine: Quarantine, why: str) -> None:
        """A comparison that was made is there no more."""
        job = self._forgotten(comparison)
        quarantine.take("comparison", comparison, [job.folder], why)

    async def remove(self, comparison: str) -> None:
        """Cancel a comparison that is being made (it stays, cancelled); remove one that is not."""
        job = self.get(comparison)
        if job.status.finished:
            self._forgotten(comparison)
            await asyncio.to_thread(shutil.rmtree, job.folder, ignore_errors=True)
        elif not await self._runner.cancel(comparison):
            error = {"code": "cancelled", "message": "cancelled before it was done"}
            with contextlib.suppress(TransitionError):
                await asyncio.to_thread(job.finish, Outcome(JobStatus.CANCELLED, error=error))
            await self._runner.cancel(comparison)  # where its turn came meanwhile
            self._runner.pending.remove(comparison)

    def _forgotten(self, comparison: str) -> Comparison:
        job = self._jobs.pop(comparison)
        self._order.remove(_key(job))
        return job

    async def close(self) -> None:
        """End; what is not made is marked interrupted."""
        await self._runner.close()
        error = {"code": "interrupted", "message": "the server ended while this comparison was being made"}
        for job in self._jobs.values():
            if not job.status.finished:
                await asyncio.to_thread(job.finish, Outcome(JobStatus.INTERRUPTED, error=error))


def _key(job: Comparison) -> Key:
    return Key(job.request.created, job.id)


def _write_request(job: Comparison) -> None:
    job.folder.mkdir()
    write_text(job.folder / REQUEST, job.request.to_json())


def _found(folder: Path) -> Comparison | None:
    """The job of a folder that an earlier server left; None where it is no job's."""
    if not _ID.fullmatch(folder.name) or not (folder / REQUEST).is_file():
        return None
    request = read_request(folder)
    if (folder / REPORT).is_file():
        return Comparison(folder, request, JobStatus.DONE)
    if (folder / ERROR).is_file():
        error = json.loads((folder / ERROR).read_text(encoding="utf-8"))
        return Comparison(folder, request, JobStatus(error.pop("status")), error)
    error = {"code": "interrupted", "message": "the server ended while this comparison was being made"}
    return Comparison(folder, request, JobStatus.INTERRUPTED, error)
