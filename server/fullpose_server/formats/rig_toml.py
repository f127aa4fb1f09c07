"""A rig as the text of a rig file, to begin one's own from."""

import json
from collections.abc import Iterator
from typing import Any

from fullpose.rig import FRAMES, Rig
from fullpose_server.formats.rig_document import FramesTable, FrameTable, RigDocument, frame_values


def rig_toml(rig: Rig) -> str:
    """The rig file of `rig`: geometry and limits, every number such that it is read back to the last bit."""
    frames = {
        FRAMES[index]: FrameTable.model_validate(frame_values(rig.frames[index])) for index in rig.geometry.frames
    }
    return toml(RigDocument(name=rig.name, geometry=rig.geometry, frames=FramesTable(**frames)))


def toml(document: RigDocument) -> str:
    """A document as a file: what was given, and nothing that is left to its default."""
    said = document.model_dump(mode="json", exclude_unset=True, exclude_none=True)
    return "\n".join(_lines(said, ())).lstrip() + "\n"


def _lines(table: dict[str, Any], path: tuple[str, ...]) -> Iterator[str]:
    plain = {key: value for key, value in table.items() if not isinstance(value, dict)}
    if path and plain:
        yield from ("", f"[{'.'.join(path)}]")
    for key, value in plain.items():
        yield f"{key} = {json.dumps(value, ensure_ascii=False)}"  # of text, numbers, truths and lists TOML's form, too
    for key, value in table.items():
        if isinstance(value, dict):
            yield from _lines(value, (*path, key))
