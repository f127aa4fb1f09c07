"""What a job's status may be: the one home of these words, for rows, folders and the API."""

from enum import StrEnum


class JobStatus(StrEnum):
    """Of a plan or a comparison."""

    QUEUED = "queued"
    RUNNING = "running"
    DONE = "done"
    FAILED = "failed"
    CANCELLED = "cancelled"
    INTERRUPTED = "interrupted"  # the server ended

    @property
    def finished(self) -> bool:
        """Whether nothing more will come of it."""
        return self not in (JobStatus.QUEUED, JobStatus.RUNNING)


UNFINISHED = tuple(status for status in JobStatus if not status.finished)
