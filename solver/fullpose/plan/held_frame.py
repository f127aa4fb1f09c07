"""The exact path that shares one frame's angles with a given path: the self-motion in closed form, by any frame.

A stretch of samples at once (mathematics, section 3). The base and the inner frame may be at any angle;
the outer and the middle one only where sin d2 cos d3 = sin(pitch) leaves the other an angle, whatever the rest do.
"""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fullpose._typing import Array
from fullpose.charts import TURN, vertical_views
from fullpose.rig import Rig
from fullpose.trajectory.frame_chart import BASE, INNER, OUTER, frames_of

HALF = math.pi
NO_POSE = math.radians(0.05)  # short of the nearest angle that has a pose by more, there is none
ROUNDING = 1e-12
UNDETERMINED = 1e-9  # a sine or cosine below leaves the other frame open
_Based = tuple[Array, NDArray[np.bool_], NDArray[np.bool_]]  # d1, whether cos d3 >= 0, whether there is a pose; (n,)


@dataclass(frozen=True)
class HeldFrame:
    """A stretch with one frame's angles given.

    `angles` (n, 4) [rad] are exact where `exists` (n,); `nearest` (n,) [rad] is the angle next to the given one that
    has an exact pose at all: the given one where it has.
    """

    angles: Array
    exists: NDArray[np.bool_]
    nearest: Array


def held_frame(rig: Rig, attitude: Array, angles: Array, frame: int) -> HeldFrame:
    """The exact path for attitude (n, 3, 3) with the angles of `frame` from angles (n, 4) [rad], on a four-axis rig.

    Of the two branches the one that lies nearer to the first of these, and continuous from there.
    """
    V = vertical_views(attitude, rig.geometry.horizontal)
    nearest = _nearest(V, angles[:, frame], frame)
    given = np.where(np.abs(nearest - angles[:, frame]) <= NO_POSE, nearest, angles[:, frame])
    if rig.geometry.horizontal and frame == OUTER:
        given = -given
    branches = [_on_branch(rig, attitude, _BASE_ANGLE[frame](V, given, sign), angles[0]) for sign in (1.0, -1.0)]
    found, exists = min(branches, key=lambda each: float(np.abs(each[0][0] - angles[0]).max()))
    found[:, frame] = angles[:, frame]
    return HeldFrame(found, exists, nearest)


def _on_branch(rig: Rig, attitude: Array, based: _Based, first: Array) -> tuple[Array, NDArray[np.bool_]]:
    """(angles (n, 4) [rad] from the turns nearest to `first` on, where they exist (n,)) of base angles."""
    base, upright, exists = based
    base = np.unwrap(base)
    base += TURN * np.rint((first[0] - base[0]) / TURN)
    found = np.empty((len(base), 4))
    frames_of(
        rig.geometry.horizontal, np.arange(float(len(base))), attitude, BASE, base, np.where(upright, 1.0, -1.0), first,
        found,
    )  # fmt: skip
    return found, exists


def _base_of_base(_V: Array, given: Array, branch: float) -> _Based:
    return given, np.full(len(given), branch > 0.0), np.ones(len(given), np.bool_)


def _base_of_outer(V: Array, given: Array, branch: float) -> _Based:
    cosine, exists = _other_factor(V, np.sin(given), 1.0)  # of d3
    return _base(V, cosine * np.cos(given), -branch * np.sqrt(1.0 - cosine**2)), cosine >= 0.0, exists


def _base_of_middle(V: Array, given: Array, branch: float) -> _Based:
    cosine = np.cos(given)
    sine, exists = _other_factor(V, cosine, 0.0)  # of d2
    return _base(V, branch * cosine * np.sqrt(1.0 - sine**2), -np.sin(given)), cosine >= 0.0, exists


def _other_factor(V: Array, factor: Array, where_none: float) -> tuple[Array, NDArray[np.bool_]]:
    """The other factor of sin d2 cos d3 = V01 (n,), and whether there is one (n,)."""
    with np.errstate(divide="ignore", invalid="ignore"):
        other = V[:, 0, 1] / factor
    exists = (np.abs(factor) > UNDETERMINED) & (np.abs(other) <= 1.0 + ROUNDING)
    return np.where(exists, np.clip(other, -1.0, 1.0), where_none), exists


def _base(V: Array, m00: Array, m02: Array) -> Array:
    """d1 from the first row of M = V Ry(d1)^T."""
    return np.arctan2(m02 * V[:, 0, 0] - m00 * V[:, 0, 2], m00 * V[:, 0, 0] + m02 * V[:, 0, 2])


def _base_of_inner(V: Array, given: Array, branch: float) -> _Based:
    c, s = np.cos(given), np.sin(given)
    n10, n12 = c * V[:, 1, 0] - s * V[:, 2, 0], c * V[:, 1, 2] - s * V[:, 2, 2]
    n20, n22 = s * V[:, 1, 0] + c * V[:, 2, 0], s * V[:, 1, 2] + c * V[:, 2, 2]
    base = np.arctan2(branch * n12, -branch * n10)
    return base, n20 * np.sin(base) + n22 * np.cos(base) >= 0.0, np.ones(len(given), np.bool_)


_BASE_ANGLE = (_base_of_base, _base_of_outer, _base_of_middle, _base_of_inner)


def _nearest(V: Array, given: Array, frame: int) -> Array:
    """The angle (n,) next to `given` (n,) at which the frame leaves the attitude an exact pose."""
    if frame in (BASE, INNER):
        return given
    leaned = np.arcsin(np.clip(np.abs(V[:, 0, 1]), 0.0, 1.0))
    off = given - HALF * np.rint(given / HALF)  # from where the sine is zero
    side = np.where(off < 0.0, -1.0, 1.0)
    if frame == OUTER:
        return np.asarray(given + side * np.maximum(0.0, leaned - np.abs(off)))
    return np.asarray(given - side * np.maximum(0.0, np.abs(off) - (0.5 * math.pi - leaned)))
