"""Trajectories on the wire."""

from datetime import datetime
from typing import Annotated, Literal, Self

from pydantic import Field, model_validator

from fullpose_server.api.schemas.base import Four, Notice, Number, Sha256, Truth, Wire
from fullpose_server.api.schemas.labels import LabelledOut
from fullpose_server.api.schemas.plans import DeviationOut
from fullpose_server.formats.column_map import ColumnMap

ConventionName = Literal["nue", "ned", "enu"]
Samples = Annotated[list[Number], Field(min_length=1, fail_fast=True)]

_EULER = {"nue": ("yaw_deg", "pitch_deg", "roll_deg"), "ned": ("heading_deg", "pitch_deg", "bank_deg")}
_EULER["enu"] = _EULER["nue"]


class TrajectoryIn(Wire):
    """A flight as JSON columns: `time_s` and one attitude, Euler angles or `q` (w, x, y, z)."""

    name: str = Field(min_length=1, max_length=200)
    convention: ConventionName = "nue"
    bridge_gaps: Truth = Field(default=False, description="Fly through gaps by interpolation")
    time_s: Samples
    yaw_deg: Samples | None = None
    heading_deg: Samples | None = None
    pitch_deg: Samples | None = None
    roll_deg: Samples | None = None
    bank_deg: Samples | None = None
    q: Annotated[list[Four], Field(fail_fast=True)] | None = None

    @model_validator(mode="after")
    def _one_attitude(self) -> Self:
        euler = _EULER[self.convention]
        given = {n for n in ("yaw_deg", "heading_deg", "pitch_deg", "roll_deg", "bank_deg") if getattr(self, n)}
        if self.q is None and given != set(euler):
            raise ValueError(f"expected {', '.join(euler)} or q for convention {self.convention}")
        if self.q is not None and given:
            raise ValueError("expected one attitude: Euler angles or q, not both")
        for column in (*given, "q"):
            values = getattr(self, column)
            if values is not None and len(values) != len(self.time_s):
                raise ValueError(f"{column} has {len(values)} values, time_s has {len(self.time_s)}")
        return self

    def columns(self) -> dict[str, list[float]]:
        """The columns a file would have."""
        table: dict[str, list[float]] = {"time_s": self.time_s}
        if self.q is not None:
            table |= {name: [row[i] for row in self.q] for i, name in enumerate(("qw", "qx", "qy", "qz"))}
        else:
            table |= {name: getattr(self, name) for name in _EULER[self.convention]}
        return table


class InputOut(Wire):
    """What was taken of a file, and what is doubtful about it."""

    format: str
    table: str = Field(description="Of a file that has several; empty otherwise")
    profile: str = Field(description="The named profile; empty where the columns were given")
    convention: ConventionName
    statement: str = Field(description="Columns, units, order, sense, axes and clock, in words")
    warnings: list[Notice]


class ReadFlight(Wire):
    """The flight that a file makes; columns of equal length, thinned."""

    samples: int = Field(description="Of the whole flight")
    duration_s: float
    convention: ConventionName
    statement: str
    warnings: list[Notice]
    time_s: list[float]
    yaw_deg: list[float]
    pitch_deg: list[float]
    roll_deg: list[float]
    q: list[Four]


class NamedProfile(Wire):
    """A shipped profile whose columns a file has."""

    name: str
    about: str


class ReadingPreview(Wire):
    """A file looked at before it is stored: what its columns are taken for, and the flight that this makes."""

    format: str
    table: str
    tables: list[str]
    names: list[str]
    units: list[str | None] = Field(description="Of each column, as the file says it")
    head: list[list[str]] = Field(description="The first rows, as text; what cannot be seen is escaped")
    profiles: list[NamedProfile]
    profile: str | None = Field(description="That was taken; null where none fits, empty where the columns were given")
    columns: ColumnMap | None
    problem: str | None = Field(description="Why it makes no flight as it is read")
    remedy: Literal["bridge_gaps", "drop_duplicates", "profile", "source"] | None = Field(
        description="The field by which it may be read all the same"
    )
    flight: ReadFlight | None


class TrajectoryOut(LabelledOut):
    """A stored flight. Its address is the SHA-256 of the attitude samples, whatever file they came in."""

    sha256: Sha256
    source_sha256: Sha256 = Field(description="SHA-256 of the uploaded bytes")
    name: str
    convention: ConventionName
    input: InputOut | None = Field(description="What was taken of the file; null of flights stored before it was kept")
    source_format: str = Field(description="csv, parquet, json, or another format that is read")
    source_bytes: int
    samples: int
    start_s: float
    duration_s: float
    rate_hz: float | None = Field(description="From the median step; null for one sample")
    uniform: bool
    peak_body_rate_deg_s: float | None
    warnings: list[Notice]
    created_at: datetime


class BodyPeaks(Wire):
    """The body's largest rate and acceleration, by differences of the samples."""

    rate_deg_s: float
    acceleration_deg_s2: float


class ToleranceEffect(Wire):
    """What a tolerance does to a flight before a rig is asked; columns of equal length for a plot."""

    samples: int
    needed: bool = Field(description="Whether the recording makes a good part of the peak acceleration")
    tolerance_deg: float | None = Field(description="That was asked for, or that is suggested")
    suggested_tolerance_deg: float | None = Field(description="Null where the recording added nothing")
    tolerance_floor_deg: float | None = Field(description="Below it no tolerance helps")
    within_tolerance: bool
    deviation_deg: DeviationOut
    cut_off_hz: float | None = Field(description="What is slower is the flight; null: nothing was taken away")
    smoothing: str = Field(description="What was taken away, in words")
    recorded: BodyPeaks
    flown: BodyPeaks
    time_s: list[float]
    deviation_at_deg: list[float]


class TrajectoryPreview(Wire):
    """A thinned flight for plots: columns of equal length."""

    sha256: Sha256
    samples: int = Field(description="Of the whole flight")
    time_s: list[float]
    yaw_deg: list[float]
    pitch_deg: list[float]
    roll_deg: list[float]
    q: list[Four]
