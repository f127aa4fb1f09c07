"""Solving without a session: the batch of POST /solve and the messages of the WebSocket /solve."""

from typing import Annotated, Literal, Self

from pydantic import Field, model_validator

from fullpose_server.api.schemas.base import (
    Four,
    FrameName,
    LimitName,
    Name,
    Number,
    Options,
    Problem,
    Three,
    Wire,
    Word,
    check_one,
)
from fullpose_server.api.schemas.plans import ReportOut


class Attitudes(Wire):
    """Attitudes at `time_s`: `q` (w, x, y, z), or `euler_deg` (yaw, pitch, roll)."""

    time_s: Annotated[list[Number], Field(min_length=1, fail_fast=True)]
    q: Annotated[list[Four], Field(fail_fast=True)] | None = None
    euler_deg: Annotated[list[Three], Field(fail_fast=True)] | None = None

    @model_validator(mode="after")
    def _one_attitude(self) -> Self:
        check_one(self, "q", "euler_deg", "one attitude: q or euler_deg")
        rows = len(self.q if self.q is not None else self.euler_deg or [])
        if rows != len(self.time_s):
            raise ValueError(f"{rows} attitudes for {len(self.time_s)} values of time_s")
        return self


class SolveIn(Attitudes):
    rig: Name
    method: Word = "exact"
    options: Options = Field(default={})
    start_deg: Four | None = None


class Limited(Wire):
    """A sample whose attitude a limit did not allow."""

    sample: int
    frame: FrameName
    limit: LimitName


class SolveOut(Wire):
    time_s: list[float]
    angles_deg: list[Four]
    error_deg: list[float]
    limited: list[Limited]
    report: ReportOut


class OpenSolve(Wire):
    """First message of the client."""

    type: Literal["open"]
    rig: Name
    method: Word = "exact"
    options: Options = Field(default={})
    start_deg: Four | None = None


class SolveSamples(Attitudes):
    """The next attitudes of the flight; time goes on from message to message."""

    type: Literal["samples"]


SolveMessageIn = Annotated[OpenSolve | SolveSamples, Field(discriminator="type")]


class Opened(Wire):
    type: Literal["opened"] = "opened"
    rig: str
    method: str


class Solved(Wire):
    """Answer to one `samples` message, row by row; `limited.sample` counts within the message."""

    type: Literal["solved"] = "solved"
    time_s: list[float]
    angles_deg: list[Four]
    error_deg: list[float]
    limited: list[Limited]


class SolveProblem(Wire):
    type: Literal["problem"] = "problem"
    problem: Problem


SolveMessageOut = Annotated[Opened | Solved | SolveProblem, Field(discriminator="type")]
