"""Remedies on the wire: what is asked for, what was changed, what it costs."""

from typing import Self

from pydantic import Field, model_validator

from fullpose.vocabulary import RemedyKind
from fullpose_server.api.schemas.base import FrameName, LimitName, RemedyName, Wire


class RemedyIn(Wire):
    """What may be changed to make a flight fit; `relax` may be asked of one frame or one kind of limit alone."""

    kind: RemedyName
    frame: FrameName | None = None
    limit: LimitName | None = None

    @model_validator(mode="after")
    def _names(self) -> Self:
        if self.kind != RemedyKind.RELAX and (self.frame is not None or self.limit is not None):
            raise ValueError(f"{self.kind} has no frame and no limit: they are for relax")
        return self


class RemedyCost(Wire):
    """What a remedy costs; null what it leaves alone."""

    longer_s: float | None = None
    longer_percent: float | None = None
    deviation_max_deg: float | None = None
    deviation_rms_deg: float | None = None
    raised_by: float | None = Field(default=None, description="In the unit of the limit; of a range on each side")
    turned_deg: float | None = None


class RemedyChange(Wire):
    """What was changed, by how much (`unit`: times, deg, deg/s or deg/s^2), that in words, and what it costs."""

    what: str = Field(description="attitude; time; the axis yaw, pitch or roll; frame and limit; or nothing")
    value: float
    unit: str
    statement: str
    cost: RemedyCost | None = None


class RemedyOut(Wire):
    """The remedy that a plan is. What was changed is null until the search has ended."""

    of: str = Field(description="The plan that it is a remedy of")
    kind: RemedyName
    frame: FrameName | None
    limit: LimitName | None
    change: RemedyChange | None
    sufficient: bool | None = Field(description="Whether the flight fits with it")
    alternatives: list[RemedyChange] = Field(description="Other single limits that would do, the least raise first")
