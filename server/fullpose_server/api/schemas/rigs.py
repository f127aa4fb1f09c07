"""Rigs on the wire."""

from typing import Any

from pydantic import Field, create_model

from fullpose_server.api.schemas.base import GeometryName, Name, Wire
from fullpose_server.formats.rig_document import FrameTable

# The keys of a rig file's frame; all are told, and what the file may leave out for no limit is null.
_FRAME: dict[str, Any] = {
    key: (float | None if field.default is None else float, ...) for key, field in FrameTable.model_fields.items()
}
FrameOut = create_model(
    "FrameOut",
    __base__=Wire,
    __doc__="One frame's limits; null means no limit. Both positions null: the frame turns without end.",
    **_FRAME,
)


class FramesOut(Wire):
    """The frames from the outside in; a three-axis rig has no base."""

    base: FrameOut | None  # type: ignore[valid-type]
    outer: FrameOut  # type: ignore[valid-type]
    middle: FrameOut  # type: ignore[valid-type]
    inner: FrameOut  # type: ignore[valid-type]


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
    scene: str = Field(description="Where the rig's 3D scene is")
