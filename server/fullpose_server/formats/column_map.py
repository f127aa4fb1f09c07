"""A column map: which columns of a table are the time and the attitude, and in which units, axes, order and sense.

The same model in the library, on the command line, in the API and in the console; TOML and JSON have the same keys:

    axes = "ned"
    [time]
    column = "timestamp"
    unit = "us"
    epoch = "first"
    [quaternion]
    columns = ["q[0]", "q[1]", "q[2]", "q[3]"]     # w, x, y, z
    sense = "body_to_reference"

or, in the place of the quaternion,

    [euler]
    columns = ["yaw", "pitch", "roll"]             # in the order in which the body is turned
    order = "ZYX"
    unit = "rad"
"""

from enum import StrEnum
from typing import Annotated, Literal, Self

from pydantic import BaseModel, ConfigDict, Field, model_validator

from fullpose_server.formats.trajectory import Convention


class TimeUnit(StrEnum):
    """What a stamp counts."""

    S = "s"
    MS = "ms"
    TENTH_MS = "0.1ms"
    US = "us"
    NS = "ns"
    MIN = "min"
    H = "h"

    @property
    def seconds(self) -> float:
        """One of it, in seconds."""
        return {"s": 1.0, "ms": 1e-3, "0.1ms": 1e-4, "us": 1e-6, "ns": 1e-9, "min": 60.0, "h": 3600.0}[self.value]

    @property
    def per_second(self) -> int:
        """How many are in a second; 0 of those that are longer. Exact, where `seconds` is rounded."""
        return {"s": 1, "ms": 10**3, "0.1ms": 10**4, "us": 10**6, "ns": 10**9}.get(self.value, 0)


class AngleUnit(StrEnum):
    """What an angle counts."""

    DEG = "deg"
    RAD = "rad"
    CENTIDEG = "centideg"


class Epoch(StrEnum):
    """Where the flight's time begins."""

    FILE = "file"  # as the file counts
    FIRST = "first"  # the first sample is at zero


class Sense(StrEnum):
    """What a quaternion takes from where to where: v_reference = q v_body q* is `body_to_reference`."""

    BODY_TO_REFERENCE = "body_to_reference"
    REFERENCE_TO_BODY = "reference_to_body"


Order = Literal["XYZ", "XZY", "YXZ", "YZX", "ZXY", "ZYX", "XYX", "XZX", "YXY", "YZY", "ZXZ", "ZYZ"]
ColumnName = Annotated[str, Field(min_length=1, max_length=200)]


class _Part(BaseModel):
    model_config = ConfigDict(frozen=True, extra="forbid")


class TimeMap(_Part):
    """The column of the stamps."""

    column: ColumnName
    unit: TimeUnit = TimeUnit.S
    epoch: Epoch = Epoch.FILE


class EulerMap(_Part):
    """Three turns about the body's own axes, one after the other; the axes are those of `axes`."""

    columns: tuple[ColumnName, ColumnName, ColumnName]  # in the order of the turns
    order: Order
    unit: AngleUnit = AngleUnit.DEG


class QuaternionMap(_Part):
    """A unit quaternion."""

    columns: tuple[ColumnName, ColumnName, ColumnName, ColumnName]  # w, x, y, z, in whatever order the file has them
    sense: Sense = Sense.BODY_TO_REFERENCE


class ColumnMap(_Part):
    """What the columns of a table are."""

    axes: Convention
    time: TimeMap
    euler: EulerMap | None = None
    quaternion: QuaternionMap | None = None

    @model_validator(mode="after")
    def _one_attitude(self) -> Self:
        if (self.euler is None) == (self.quaternion is None):
            raise ValueError("expected one attitude, euler or quaternion")
        return self

    @property
    def attitude(self) -> tuple[str, ...]:
        """The attitude's columns."""
        part = self.euler or self.quaternion
        return () if part is None else part.columns

    @property
    def columns(self) -> tuple[str, ...]:
        """Every column that is read, the time first."""
        return (self.time.column, *self.attitude)
