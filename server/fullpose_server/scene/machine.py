"""The machine's solids for a rig: what stands on the floor, and one set a frame, in that frame's axes.

Every frame has its shafts on its own axis and the bearings of the next frame on that one's axis:

- the outermost: a fork on a turntable where it turns about y (vertical), a ring between two towers where about z;
- rings in the y-z plane between;
- the last but one: a yoke, open toward the nose, with the roll motor behind;
- the innermost (x): shaft, face plate and the payload.
"""

import math
from dataclasses import dataclass

import numpy as np
import trimesh

from fullpose.rig import FRAMES, Geometry, X, Y
from fullpose_server.scene import palette
from fullpose_server.scene.shapes import arc, drum, joined, slab, tower

EX, EY, EZ = np.eye(3)
Point = tuple[float, float, float]


@dataclass(frozen=True)
class Part:
    """A solid of one colour. `main` parts carry the frame's colour and appear in the ghost."""

    name: str
    mesh: trimesh.Trimesh
    colour: str
    main: bool = False


@dataclass(frozen=True)
class Stage:
    """One frame of the machine."""

    frame: str  # of FRAMES
    axis: int  # X, Y or Z
    parts: tuple[Part, ...]
    label_at: Point  # in the frame's axes [m]


@dataclass(frozen=True)
class Machine:
    """The whole: static parts, frames from the outside in, payload parts (in the innermost frame's axes)."""

    static: tuple[Part, ...]
    stages: tuple[Stage, ...]
    payload: tuple[Part, ...]
    floor: float  # height y of the floor [m]
    reach: float  # radius of the outermost moving part [m]
    clear: float  # radius kept clear around the payload [m]


def build(geometry: Geometry, size_m: tuple[float, float, float], payload: trimesh.Trimesh | None = None) -> Machine:
    """The machine around a payload box of `size_m` (along x, y, z), or around a payload mesh in body axes [m]."""
    if payload is not None:
        low, high = payload.bounds
        clear = float(np.linalg.norm(np.maximum(np.abs(low), np.abs(high))))
        back = float(low[0])
    else:
        clear = 0.5 * float(np.linalg.norm(size_m))
        back = -0.5 * size_m[0]
    clear *= 1.12
    frames = geometry.frames
    axes = [geometry.axes[i] for i in frames]
    gap = 0.24 * clear
    yoke = clear + 0.62 * gap
    # Radii from the inside out: yoke, rings, fork or first ring.
    radii = {len(frames) - 2: yoke}
    for i in range(len(frames) - 3, -1, -1):
        radii[i] = radii[i + 1] + gap * 1.25
    stages = []
    for i in range(len(frames) - 1):
        name = FRAMES[frames[i]]
        last = i == len(frames) - 2
        if last:
            parts, label = _yoke(name, axes[i], radii[i], gap)
        elif i == 0 and axes[i] == Y:
            parts, label = _fork(name, radii[i], gap)
        else:
            parts, label = _ring(name, axes[i], axes[i + 1], radii[i], gap)
        stages.append(Stage(name, axes[i], parts, label))
    parts, label = _roll(FRAMES[frames[-1]], back, yoke, clear, gap)
    stages.append(Stage(FRAMES[frames[-1]], X, parts, label))

    if axes[0] == Y:
        static, floor = _pedestal(radii[0], gap)
    else:
        static, floor = _towers(radii[0], gap)
    body = _box(size_m) if payload is None else (Part("body", payload, palette.PAYLOAD, main=True),)
    return Machine(static, tuple(stages), body, floor, radii[0] + gap, clear)


def _bearings(axis: int, radius: float, gap: float, size: float = 0.5) -> trimesh.Trimesh:
    """The two bearing housings that the next frame's shafts turn in, on +-`axis` at `radius`."""
    e = np.eye(3)[axis]
    reach = 0.36 * gap
    return joined(*(drum(size * gap, s * e * (radius - reach), s * e * (radius + reach)) for s in (-1.0, 1.0)))


def _shafts(axis: int, inside: float, outside: float, gap: float) -> trimesh.Trimesh:
    e = np.eye(3)[axis]
    return joined(*(drum(0.2 * gap, s * e * inside, s * e * outside, sections=32) for s in (-1.0, 1.0)))


def _ring(name: str, axis: int, inner: int, radius: float, gap: float) -> tuple[tuple[Part, ...], Point]:
    colour = palette.FRAME_COLOURS[name]
    body = joined(arc(radius, 0.62 * gap, 0.4 * gap, EX, EY))
    parts = (
        Part("ring", body, colour, main=True),
        Part("bearings", _bearings(inner, radius, gap), palette.BEARING),
        Part("shafts", _shafts(axis, radius + 0.1 * gap, radius + 1.35 * gap, gap), palette.SHAFT),
    )
    at = math.sqrt(0.5) * (radius + 0.3 * gap)
    return parts, (0.0, at, at)


def _yoke(name: str, axis: int, radius: float, gap: float) -> tuple[tuple[Part, ...], Point]:
    e = np.eye(3)[axis]
    body = joined(
        arc(radius, 0.7 * gap, 0.4 * gap, np.cross(e, -EX), e, math.pi),
        *(drum(0.46 * gap, s * e * (radius - 0.2 * gap), s * e * (radius + 0.2 * gap)) for s in (-1.0, 1.0)),
    )
    motor = joined(
        drum(0.62 * gap, -EX * (radius - 0.42 * gap), -EX * (radius + 0.5 * gap)),
        drum(0.42 * gap, -EX * (radius + 0.5 * gap), -EX * (radius + 0.62 * gap)),
    )
    parts = (
        Part("yoke", body, palette.FRAME_COLOURS[name], main=True),
        Part("motor", motor, palette.BEARING),
        Part("shafts", _shafts(axis, radius + 0.1 * gap, radius + 1.35 * gap, gap), palette.SHAFT),
    )
    at = math.sqrt(0.5) * (radius + 0.4 * gap)
    return parts, (-at, at * float(e[1]), at * float(e[2]))


def _fork(name: str, radius: float, gap: float) -> tuple[tuple[Part, ...], Point]:
    table = -(radius + 0.95 * gap)
    body = joined(
        arc(radius, 1.0 * gap, 0.5 * gap, EX, EZ, math.pi),
        *(slab((gap, 0.4 * gap, 0.5 * gap), s * EZ * radius + 0.2 * gap * EY) for s in (-1.0, 1.0)),
        drum(1.5 * gap, EY * (table + 0.3 * gap), EY * (-radius + 0.1 * gap), end_radius=0.6 * gap),
        drum(0.62 * radius, EY * (table), EY * (table + 0.32 * gap)),
    )
    index = slab((0.16 * radius, 0.1 * gap, 0.1 * gap), (0.5 * radius, table + 0.35 * gap, 0.0))
    parts = (
        Part("fork", body, palette.FRAME_COLOURS[name], main=True),
        Part("index", index, palette.PAYLOAD),
        Part("bearings", _bearings(2, radius, gap, 0.56), palette.BEARING),
    )
    at = math.sqrt(0.5) * (radius + 0.4 * gap)
    return parts, (0.0, -at, at)


def _roll(name: str, back: float, yoke: float, clear: float, gap: float) -> tuple[tuple[Part, ...], Point]:
    plate = 0.62 * clear
    front = back
    body = joined(
        drum(plate, EX * (front - 0.16 * gap), EX * front),
        # The rim's tooth: roll can be read from it.
        slab((0.16 * gap, 0.3 * gap, 0.34 * gap), (front - 0.08 * gap, plate + 0.08 * gap, 0.0)),
        drum(0.34 * gap, EX * (front - 0.3 * gap), EX * (front - 0.14 * gap), end_radius=0.9 * gap),
    )
    shaft = joined(drum(0.26 * gap, -EX * (yoke - 0.3 * gap), EX * (front - 0.2 * gap), sections=32))
    parts = (Part("plate", body, palette.FRAME_COLOURS[name], main=True), Part("shaft", shaft, palette.SHAFT))
    return parts, (front - 0.1 * gap, plate + 0.35 * gap, 0.0)


def _box(size_m: tuple[float, float, float]) -> tuple[Part, ...]:
    """A seeker's box: a light housing with a dark window toward the nose."""
    x, y, z = size_m
    window = 0.36 * min(y, z)
    return (
        Part("body", joined(slab(size_m, (0, 0, 0))), palette.PAYLOAD, main=True),
        Part("window", joined(drum(window, EX * 0.49 * x, EX * (0.5 * x + 0.16 * window))), palette.PAYLOAD_DARK),
        Part("keel", slab((0.8 * x, 0.02 * y, 0.12 * z), (0.0, 0.505 * y, 0.0)), palette.AXIS_COLOURS[1]),
    )


def _pedestal(radius: float, gap: float) -> tuple[tuple[Part, ...], float]:
    top = -(radius + 0.95 * gap)
    floor = top - 1.7 * gap
    body = joined(
        drum(0.74 * radius, EY * (top - 0.3 * gap), EY * (top - 0.03 * gap)),
        drum(0.8 * radius, EY * floor, EY * (top - 0.3 * gap), end_radius=0.6 * radius),
        drum(0.9 * radius, EY * floor, EY * (floor + 0.18 * gap)),
    )
    return (Part("pedestal", body, palette.STATIC),), floor


def _towers(radius: float, gap: float) -> tuple[tuple[Part, ...], float]:
    floor = -(radius + 1.5 * gap)
    z = radius + 1.15 * gap
    body = joined(
        *(tower((2.6 * radius / 2, 1.0 * gap), (1.3 * gap, 0.7 * gap), floor, 0.5 * gap, s * z) for s in (-1.0, 1.0)),
        slab((1.5 * radius, 0.3 * gap, 2.0 * z + 1.6 * gap), (0.0, floor + 0.15 * gap, 0.0)),
    )
    caps = joined(*(drum(0.62 * gap, s * EZ * (z - 0.5 * gap), s * EZ * (z + 0.5 * gap)) for s in (-1.0, 1.0)))
    return (Part("towers", body, palette.STATIC), Part("caps", caps, palette.BEARING)), floor
