"""Colours of the scene. The console uses the same four for the frames, so that a curve and a ring match."""

from typing import Final

Rgb = tuple[int, int, int]

# Base, outer, middle, inner: as in fullpose.rig.FRAMES.
FRAME_COLOURS: Final[dict[str, str]] = {
    "base": "#4c78a8",
    "outer": "#f58518",
    "middle": "#54a24b",
    "inner": "#e45756",
}
# Body and reference axes x, y, z.
AXIS_COLOURS: Final[tuple[str, str, str]] = ("#e03131", "#2f9e44", "#1c7ed6")
STATIC: Final = "#7c848c"  # what stands on the floor
BEARING: Final = "#3d434a"
SHAFT: Final = "#c3c8cd"
PAYLOAD: Final = "#e9ecef"
PAYLOAD_DARK: Final = "#23272b"
GHOST: Final = "#339af0"  # commanded
PREVIEW: Final = "#da77f2"  # a planned pose being looked at
TARGET: Final = "#ffd43b"  # the flight's attitude


def rgb(colour: str) -> Rgb:
    """(r, g, b) 0..255 of "#rrggbb"."""
    value = int(colour.removeprefix("#"), 16)
    return value >> 16, value >> 8 & 0xFF, value & 0xFF
