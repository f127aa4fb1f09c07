"""A rig as the text of a rig file, to begin one's own from."""

import math

from fullpose.rig import FRAMES, Rig
from fullpose_server.formats.degrees import written_degrees
from fullpose_server.formats.rig_file import FRAME_KEYS


def rig_toml(rig: Rig) -> str:
    """The rig file of `rig`: geometry and limits, every number such that it is read back to the last bit."""
    lines = [f'name = "{rig.name}"', f'geometry = "{rig.geometry}"']
    for index in rig.geometry.frames:
        lines += ["", f"[frames.{FRAMES[index]}]"]
        for key, field in FRAME_KEYS.items():
            value = getattr(rig.frames[index], field)
            if math.isfinite(value):
                lines.append(f"{key} = {value if key == 'weight' else written_degrees(value)!r}")
    return "\n".join(lines) + "\n"
