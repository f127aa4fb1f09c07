"""The plane of time and base angle of a plan on the wire. Degrees, seconds, per cent."""

from pydantic import Field

from fullpose_server.api.schemas.base import FrameName, LimitName, Wire

CODE = "1 + 3 * frame + limit, of base, outer, middle, inner and position, rate, acceleration from 0; 0: none"


class NeedleOut(Wire):
    """A point that paths run exactly through, changing the side of cos d3, or pass by the half width at least."""

    time_s: float
    base_deg: float = Field(description="Half a turn on is another")
    half_width_deg: float


class PlanePathOut(Wire):
    """The plan at the times of the map."""

    base_deg: list[float]
    side: list[int] = Field(description="0 where cos d3 >= 0, else 1")
    margin: list[float] = Field(description="Least share left about there of any limit, accelerations too [per cent]")
    limit: list[int] = Field(description=CODE)


class TightestOut(Wire):
    """Where the plan leaves least of a limit."""

    time_s: float
    margin: float = Field(description="Per cent, rounded down; negative beyond the limit")
    frame: FrameName | None
    limit: LimitName | None
    sentence: str


class PlaneOut(Wire):
    """What a path can leave of the limits at most, over time (from the flight's begin) and base angle.

    `margin` and `limits` are base64 of a byte a cell: first the side cos d3 >= 0, then the other; of each time after
    time, of each base angle after base angle, evenly from the first to the last of `base_deg`.
    """

    time_s: list[float]
    base_deg: tuple[float, float]
    rows: int
    margin: str = Field(description="Signed, per cent rounded down; negative: no path passes there inside the limits")
    limits: str = Field(description=f"Lower half: the limit that leaves no more, {CODE}; upper: the one that holds it")
    needles: list[NeedleOut] = Field(description="The widest, by time")
    needles_left_out: int
    path: PlanePathOut
    tightest: TightestOut
