"""The scene on the wire: which planned pose it shows beside the rig."""

from pydantic import Field

from fullpose_server.api.schemas.base import Four, Number, Wire, Word


class ScenePoseIn(Wire):
    """An instant of a plan."""

    plan_id: Word
    time_s: Number = Field(description="Zero is the flight's first sample; negative in the lead-in")


class ScenePoseOut(Wire):
    """What is shown: the plan's sample nearest to the time asked for."""

    plan_id: str
    time_s: float
    angles_deg: Four
    q: Four | None = Field(description="The flight's attitude (w, x, y, z); null in the leads")
    error_deg: float | None
