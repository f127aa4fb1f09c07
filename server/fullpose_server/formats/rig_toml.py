"""A rig as the text of a rig file, to begin one's own from."""

from fullpose.rig import FRAMES, Rig
from fullpose_server.formats.rig_document import FramesTable, FrameTable, RigDocument, frame_values
from fullpose_server.formats.toml_text import toml


def rig_toml(rig: Rig) -> str:
    """The rig file of `rig`: geometry and limits, every number such that it is read back to the last bit."""
    frames = {
        FRAMES[index]: FrameTable.model_validate(frame_values(rig.frames[index])) for index in rig.geometry.frames
    }
    return toml(RigDocument(name=rig.name, geometry=rig.geometry, frames=FramesTable(**frames)))
