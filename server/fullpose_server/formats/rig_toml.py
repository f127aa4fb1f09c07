"""A rig as the text of a rig file, to begin one's own from."""

import math

from fullpose.rig import FRAMES, Rig
from fullpose_server.formats.rig_file import FRAME_KEYS


def rig_toml(rig: Rig) -> str:
    """The rig file of `rig`: geometry and limits, every number such that it is read back to the last bit."""
    lines = [f'name = "{rig.name}"', f'geometry = "{rig.geometry}"']
    for index in rig.geometry.frames:
        lines += ["", f"[frames.{FRAMES[index]}]"]
        for key, field in FRAME_KEYS.items():
            value = getattr(rig.frames[index], field)
            if math.isfinite(value):
                lines.append(f"{key} = {value if key == 'weight' else _degrees(value)!r}")
    return "\n".join(lines) + "\n"


def _degrees(value: float) -> float:
    """The shortest number of degrees that is `value` [rad]; rounding of `math.degrees` alone would change it."""
    degrees = math.degrees(value)
    tried = [round(degrees, digits) for digits in range(18)]
    tried += [math.nextafter(degrees, -math.inf), math.nextafter(degrees, math.inf)]
    return next((number for number in tried if math.radians(number) == value), degrees)
