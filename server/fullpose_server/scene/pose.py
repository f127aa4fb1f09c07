"""From frame angles to the scene's node orientations.

The solver's rotations are passive: they carry vector components from the outer frame into the inner one. A scene
node's quaternion is the active one, "to parent from local", so it is the transpose: a turn of +angle about the axis.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from fullpose._typing import Array
from fullpose.rig import ABSENT, Rig


@dataclass(frozen=True)
class Pose:
    """What is to be seen: angles (4,) [rad], base first; target (4,) quaternion (w, x, y, z) or None."""

    measured: Array
    commanded: Array | None
    target: Array | None


def frame_quaternions(rig: Rig, angles: ArrayLike) -> list[Array]:
    """Active quaternion (w, x, y, z) of each frame the rig has, outside in, each relative to the one around it.

    angles (4,) [rad], base first; the base column of a three-axis rig is not read.
    """
    half = 0.5 * np.asarray(angles, dtype=np.float64)
    quaternions = []
    for axis, angle in zip(rig.geometry.axes, half, strict=True):
        if axis == ABSENT:
            continue
        q = np.zeros(4)
        q[0] = np.cos(angle)
        q[1 + axis] = np.sin(angle)
        quaternions.append(q)
    return quaternions


def multiply(quaternions: Sequence[Array]) -> Array:
    """The product of quaternions (w, x, y, z), left to right: what nesting the nodes amounts to."""
    w, x, y, z = 1.0, 0.0, 0.0, 0.0
    for a, b, c, d in quaternions:
        w, x, y, z = (
            w * a - x * b - y * c - z * d,
            w * b + x * a + y * d - z * c,
            w * c - x * d + y * a + z * b,
            w * d + x * c - y * b + z * a,
        )
    return np.array([w, x, y, z])
