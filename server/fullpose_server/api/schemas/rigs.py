"""Rigs on the wire."""

from pydantic import Field

from fullpose_server.api.schemas.base import GeometryName, Name, Wire


class FrameOut(Wire):
    """One frame's limits; null means no limit. Both positions null: the frame turns without end."""

    min_deg: float | None
    max_deg: float | None
    max_rate_deg_s: float | None
    max_acceleration_deg_s2: float | None
    weight: float
    home_deg: float


class FramesOut(Wire):
    """The frames from the outside in; a three-axis rig has no base."""

    base: FrameOut | None
    outer: FrameOut
    middle: FrameOut
    inner: FrameOut


class PayloadOut(Wire):
    """What the rig carries, for the scene: a box or a mesh file."""

    size_m: tuple[float, float, float] | None = None
    mesh: str | None = None


class RigOut(Wire):
    """A rig the server knows, and the state of its session."""

    name: Name
    geometry: GeometryName
    redundant: bool
    builtin: bool
    rig_hash: str
    frames: FramesOut
    payload: PayloadOut
    state: str = Field(description="Session state; disconnected where no rig process runs")
