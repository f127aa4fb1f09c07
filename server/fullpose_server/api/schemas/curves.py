"""Curves of a run on the wire: what there is, and windows of it.

A window is little-endian binary: magic u4 "FPC1", columns u4, buckets u4, samples u4 (1: every bucket is one sample),
then for each column, in the order of `columns`, its least values as f8 and, unless `samples`, its greatest ones. A
value that is not a number is none. `time_s` is the first column: when a bucket begins and ends.
"""

from typing import Literal

from pydantic import Field

from fullpose_server.api.schemas.base import Wire


class CurveEvent(Wire):
    """What happened in a run, to be found on the time axis."""

    at_s: float = Field(description="After the first sample")
    kind: Literal["command", "alarm", "transition", "begin", "end", "gap"]
    text: str
    severity: Literal["fault", "warning"] | None = Field(description="Of an alarm")


class DifferenceOut(Wire):
    """What a run is compared with. `time_s` is the run's, of the reference's samples those of the same moment."""

    kind: Literal["run", "plan"]
    id: str
    aligned: Literal["flight", "run"] = Field(
        description="By the time of the flight; or, where one of both has none, by the time since it began to run"
    )
    columns: list[str]
    turned_deg: list[float] = Field(description="Whole revolutions by which the reference was moved, by frame")


class CurvesOut(Wire):
    """The curves of a run, or how far they are from being made."""

    ready: bool
    progress: float = Field(description="What part of them is made, 0 to 1: ask again until they are ready")
    samples: int
    duration_s: float
    started: float | None = Field(description="Seconds since 1970, of the first sample")
    record_sha256: str | None = Field(description="Of the record that they were made of")
    columns: list[str]
    events: list[CurveEvent]
    events_left_out: int = Field(description="How many later ones there are than are listed")
    against: DifferenceOut | None
