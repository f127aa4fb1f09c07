"""A job: what a runner is given, asks of it, and tells it."""

from collections.abc import Mapping
from dataclasses import dataclass
from enum import StrEnum
from typing import Any, Protocol

from fullpose_server.store.jobs import JobStatus


class Kind(StrEnum):
    """What the worker process can make."""

    PLAN = "plan"
    COMPARISON = "comparison"


@dataclass(frozen=True)
class Progress:
    """How far a job is: what is being done, and how much of it."""

    phase: str
    done: int
    total: int


@dataclass(frozen=True)
class Outcome:
    """How a job ended: its result where it is done, else its error (`code`, `message`)."""

    status: JobStatus
    result: Mapping[str, Any] | None = None
    error: Mapping[str, str] | None = None


def failed(code: str, message: str) -> Outcome:
    """The outcome of a job that failed."""
    return Outcome(JobStatus.FAILED, error={"code": code, "message": message})


class Job(Protocol):
    """One job. Both methods are called in a thread: they may wait for a disk."""

    @property
    def id(self) -> str:
        """Unlike any other job's of the same runner."""
        ...

    @property
    def kind(self) -> Kind:
        """Who makes it, in the worker process."""
        ...

    def begin(self) -> Mapping[str, Any] | None:
        """Mark it running; what the worker is told (values for `json`), or None where it is no longer wanted."""
        ...

    def finish(self, outcome: Outcome) -> None:
        """Write down how it ended. Raises `TransitionError` where that is written already."""
        ...
