"""The nodes of one instant: a grid over both charts of the self-motion curve (mathematics, sections 3 and 8).

The null vector of the vertical rig is proportional to (c3, -s2 s3, -c2 c3, -s2): where |cos d3| >= |sin d2| the base
moves fastest along the curve, elsewhere the inner frame does. Each chart is therefore used only where its own angle
is the fastest (with some overlap), so that neighbouring nodes lie one grid step apart at most, in every frame: the
grid covers the curve, and a node path that is missing on it, with rates widened by that step, is missing altogether.
Near the singularity, where both measures vanish, that bound does not hold.
"""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fullpose._jit import kernel
from fullpose._typing import Array, Integers
from fullpose.charts import TURN
from fullpose.rig import Rig

OVERLAP = 0.8  # share of the other chart's measure from which a chart is used
NARROW = 3.0  # grid steps; a range below may hold no node
CLEARANCE = 1e-4  # sin^2 d2 + cos^2 d3 below which a point is no node: half a degree from the singularity


@dataclass(frozen=True)
class Lattice:
    """The grid of a rig: which frames turn freely, and how many turns of the others are kept apart."""

    horizontal: bool
    size: int  # G, grid points a turn; nodes are (chart, branch, grid point): 4 G
    low: Array  # (4,) [rad] of the lowest copy; -pi for a frame that wraps
    high: Array  # (4,) [rad]; inf for a frame that wraps
    wraps: NDArray[np.bool_]  # (4,) frames whose turns are not counted
    copies: Integers  # (4,) turns kept apart

    @property
    def step(self) -> float:
        """Grid spacing [rad]."""
        return TURN / self.size

    @property
    def states(self) -> int:
        """Nodes times copies."""
        return 4 * self.size * int(np.prod(self.copies))


def lattice(rig: Rig, grid: float, counted: NDArray[np.bool_] | None = None, slack: float = 0.0) -> Lattice:
    """The grid for a rig: `grid` [rad]; `counted` (4,) the frames of more than one turn whose turns are told apart.

    A frame with a range below one turn has one copy of every angle and is never ambiguous. One of a turn or more is
    first taken as free; only where the unwrapped result leaves its range must its turns be counted. `slack` [rad]
    widens the ranges. A range that the grid may step over altogether is widened by a step; the refinement sees to it.
    """
    size = max(8, round(TURN / grid))
    narrow = rig.position_max - rig.position_min < NARROW * TURN / size
    slack_of = np.where(narrow, max(slack, TURN / size), slack)
    low = rig.position_min - slack_of
    high = rig.position_max + slack_of
    span = high - low
    wraps = span >= TURN
    if counted is not None:
        wraps &= ~(counted & np.isfinite(span))
    copies = np.where(wraps | (span < TURN), 1.0, np.floor(np.where(wraps, 0.0, span) / TURN + 1e-12) + 1.0)
    return Lattice(
        horizontal=rig.geometry.horizontal,
        size=size,
        low=np.where(wraps, -math.pi, low),
        high=np.where(wraps, math.inf, high),
        wraps=wraps,
        copies=copies.astype(np.int64),
    )


@kernel
def _put(d: float, low: float) -> float:
    return low + (d - low) - TURN * math.floor((d - low) / TURN)


@kernel
def fill_nodes(
    horizontal: bool,
    C: Array,
    cosines: Array,
    sines: Array,
    low: Array,
    high: Array,
    position: Array,
    measure: Array,
    alive: NDArray[np.bool_],
) -> int:
    """The nodes of one attitude; returns how many are alive (inside their range, in their chart's own region).

    C (3, 3); cosines, sines (G,) of the grid angles -pi + g step; low, high (4,) [rad]. Out: position (4G, 4) [rad]
    with each angle in [low, low + 2 pi), measure (4G,) sin^2 d2 + cos^2 d3, alive (4G,).
    """
    G = cosines.shape[0]
    step = TURN / G
    # V: the attitude as the vertical rig sees it (fullpose.charts).
    V = np.empty((3, 3))
    if horizontal:
        V[0, 0], V[0, 1], V[0, 2] = C[0, 0], C[0, 2], -C[0, 1]
        V[1, 0], V[1, 1], V[1, 2] = C[2, 0], C[2, 2], -C[2, 1]
        V[2, 0], V[2, 1], V[2, 2] = -C[1, 0], -C[1, 2], C[1, 1]
    else:
        V[:] = C
    side = -1.0 if horizontal else 1.0
    d = np.empty(4)
    count = 0
    for g in range(G):
        c = cosines[g]
        s = sines[g]
        angle = -math.pi + step * g
        # Base chart, both branches: M = V Ry(d1)^T.
        m00 = V[0, 0] * c - V[0, 2] * s
        m01 = V[0, 1]
        m02 = V[0, 0] * s + V[0, 2] * c
        c3 = math.hypot(m00, m01)
        alive[g] = False
        alive[G + g] = False
        if c3 > 1e-6 and c3 * c3 >= OVERLAP * abs(m01):
            clear = c3 * c3 + (m01 / c3) ** 2
            if clear >= CLEARANCE:
                m12 = V[1, 0] * s + V[1, 2] * c
                m22 = V[2, 0] * s + V[2, 2] * c
                d2 = math.atan2(m01, m00)
                d3 = math.atan2(-m02, c3)
                d4 = math.atan2(m12, m22)
                for branch in range(2):
                    i = branch * G + g
                    d[0] = angle
                    d[1] = side * d2 if branch == 0 else side * d2 + math.pi
                    d[2] = d3 if branch == 0 else math.pi - d3
                    d[3] = d4 if branch == 0 else d4 + math.pi
                    inside = True
                    for k in range(4):
                        position[i, k] = _put(d[k], low[k])
                        if position[i, k] > high[k]:
                            inside = False
                    measure[i] = clear
                    alive[i] = inside
                    if inside:
                        count += 1
        # Inner chart: N = Rx(d4)^T V.
        n01 = V[0, 1]
        n10 = c * V[1, 0] - s * V[2, 0]
        n12 = c * V[1, 2] - s * V[2, 2]
        s2 = math.hypot(n10, n12)
        alive[2 * G + g] = False
        alive[3 * G + g] = False
        if s2 > 1e-6 and s2 * s2 >= OVERLAP * abs(n01):
            clear = s2 * s2 + (n01 / s2) ** 2
            if clear >= CLEARANCE:
                n11 = c * V[1, 1] - s * V[2, 1]
                n21 = s * V[1, 1] + c * V[2, 1]
                d1 = math.atan2(n12, -n10)
                d2 = math.atan2(s2, n11)
                d3 = math.atan2(n21, n01)
                for branch in range(2):
                    i = (2 + branch) * G + g
                    d[0] = d1 if branch == 0 else d1 + math.pi
                    d[1] = side * d2 if branch == 0 else -side * d2
                    d[2] = d3 if branch == 0 else d3 + math.pi
                    d[3] = angle
                    inside = True
                    for k in range(4):
                        position[i, k] = _put(d[k], low[k])
                        if position[i, k] > high[k]:
                            inside = False
                    measure[i] = clear
                    alive[i] = inside
                    if inside:
                        count += 1
    return count


def grid_circle(size: int) -> tuple[Array, Array]:
    """(cosines, sines) of the grid angles -pi + g 2 pi / size."""
    angle = -math.pi + TURN / size * np.arange(size)
    return np.cos(angle), np.sin(angle)
