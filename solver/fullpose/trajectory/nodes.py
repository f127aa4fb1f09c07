"""The nodes of one instant: a grid over both charts of the self-motion curve (mathematics, sections 3 and 8).

The null vector of the vertical rig is proportional to (c3, -s2 s3, -c2 c3, -s2): where |cos d3| >= |sin d2| the base
moves fastest along the curve, elsewhere the inner frame does. Each chart is therefore used only where its own angle
is the fastest (with some overlap), so that neighbouring nodes lie one grid step apart at most, in every frame: the
grid covers the curve, and a node path that is missing on it, with rates widened by that step, is missing altogether.
Near the singularity, where both measures vanish, that bound does not hold.
"""

import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from fullpose._jit import inlined, kernel
from fullpose._typing import Array, Integers
from fullpose.charts import TURN, vertical_view
from fullpose.rig import Rig

OVERLAP = 0.8  # share of the other chart's measure from which a chart is used
NARROW = 3.0  # grid steps; a range below may hold no node
LEAST = 1e-6  # |cos d3| or |sin d2| of a chart's node
CLEARANCE = 1e-4  # sin^2 d2 + cos^2 d3 below which a point is no node: half a degree from the singularity


class Grid(NamedTuple):
    """What the nodes of an instant are made on."""

    cosines: Array  # (G,) of the grid angles -pi + g 2 pi / G
    sines: Array
    low: Array  # (4,) [rad] the ranges that the nodes must be in
    high: Array


class Nodes(NamedTuple):
    """The nodes of an instant, (chart, branch, grid point) in this order."""

    position: Array  # (4G, 4) [rad] each angle in [low, low + 2 pi)
    measure: Array  # (4G,) sin^2 d2 + cos^2 d3; 1 where the node is not in its chart's own region
    alive: NDArray[np.bool_]  # (4G,) inside their range, in their chart's own region


def node_grid(size: int, low: Array, high: Array) -> Grid:
    """The grid of `size` points a turn, for nodes with ranges low, high (4,) [rad]."""
    angle = -math.pi + TURN / size * np.arange(size)
    return Grid(np.cos(angle), np.sin(angle), low, high)


def empty_nodes(size: int) -> Nodes:
    """Nodes for `fill_nodes` to fill, of a grid of `size` points a turn."""
    return Nodes(np.zeros((4 * size, 4)), np.ones(4 * size), np.zeros(4 * size, np.bool_))


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
    def nodes(self) -> Grid:
        """What the nodes are made on."""
        return node_grid(self.size, self.low, self.high)

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


@inlined
def angle_from(low: float, d: float) -> float:
    """The angle d [rad] in [low, low + 2 pi)."""
    return low + (d - low) - TURN * math.floor((d - low) / TURN)


@inlined
def view(horizontal: bool, C: Array, V: Array) -> None:
    """V (3, 3) <- C (3, 3) as the vertical rig sees it."""
    v = vertical_view(horizontal, C)
    for i in range(3):
        for j in range(3):
            V[i, j] = v[3 * i + j]


@inlined
def base_angles(V: Array, c: float, s: float) -> tuple[float, float, float, float]:
    """(measure, d2, d3, d4) of the base chart's branch +1 where d1 has cosine c and sine s; measure 0: no node.

    V (3, 3): the attitude as the vertical rig sees it. M = V Ry(d1)^T.
    """
    m00 = V[0, 0] * c - V[0, 2] * s
    m01 = V[0, 1]
    c3 = math.hypot(m00, m01)
    if not (c3 > LEAST and c3 * c3 >= OVERLAP * abs(m01)):
        return 0.0, 0.0, 0.0, 0.0
    measure = c3 * c3 + (m01 / c3) ** 2
    if measure < CLEARANCE:
        return 0.0, 0.0, 0.0, 0.0
    m02 = V[0, 0] * s + V[0, 2] * c
    m12 = V[1, 0] * s + V[1, 2] * c
    m22 = V[2, 0] * s + V[2, 2] * c
    return measure, math.atan2(m01, m00), math.atan2(-m02, c3), math.atan2(m12, m22)


@inlined
def inner_angles(V: Array, c: float, s: float) -> tuple[float, float, float, float]:
    """(measure, d1, d2, d3) of the inner chart's branch +1 where d4 has cosine c and sine s. N = Rx(d4)^T V."""
    n01 = V[0, 1]
    n10 = c * V[1, 0] - s * V[2, 0]
    n12 = c * V[1, 2] - s * V[2, 2]
    s2 = math.hypot(n10, n12)
    if not (s2 > LEAST and s2 * s2 >= OVERLAP * abs(n01)):
        return 0.0, 0.0, 0.0, 0.0
    measure = s2 * s2 + (n01 / s2) ** 2
    if measure < CLEARANCE:
        return 0.0, 0.0, 0.0, 0.0
    n11 = c * V[1, 1] - s * V[2, 1]
    n21 = s * V[1, 1] + c * V[2, 1]
    return measure, math.atan2(n12, -n10), math.atan2(s2, n11), math.atan2(n21, n01)


@inlined
def node_pose(side: float, V: Array, chart: int, angle: float, c: float, s: float, d: Array) -> float:
    """d <- the pose on branch +1 of a chart (0 base, 1 inner) at its own angle [rad]; returns the measure, 0: no node.

    side: -1 for the horizontal rig, whose d2 counts the other way.
    """
    if chart == 0:
        measure, d2, d3, d4 = base_angles(V, c, s)
        d[0], d[1], d[2], d[3] = angle, side * d2, d3, d4
    else:
        measure, d1, d2, d3 = inner_angles(V, c, s)
        d[0], d[1], d[2], d[3] = d1, side * d2, d3, angle
    return measure


@inlined
def other_branch(chart: int, d: Array) -> None:
    """d <- the other pose with the chart's own angle."""
    if chart == 0:
        d[1] += math.pi
        d[2] = math.pi - d[2]
        d[3] += math.pi
    else:
        d[0] += math.pi
        d[1] = -d[1]
        d[2] += math.pi


@kernel
def fill_nodes(horizontal: bool, C: Array, grid: Grid, nodes: Nodes) -> int:
    """nodes <- those of the attitude C (3, 3); returns how many are alive."""
    # Out of the loops: to take an array from a tuple counts its owners.
    cosines, sines, low, high = grid
    position, measures, alive = nodes
    G = cosines.shape[0]
    step = TURN / G
    V = np.empty((3, 3))
    view(horizontal, C, V)
    side = -1.0 if horizontal else 1.0
    d = np.empty(4)
    count = 0
    for g in range(G):
        for chart in range(2):
            measure = node_pose(side, V, chart, -math.pi + step * g, cosines[g], sines[g], d)
            for branch in range(2):
                i = (2 * chart + branch) * G + g
                alive[i] = False
                if measure == 0.0:
                    continue
                if branch == 1:
                    other_branch(chart, d)
                inside = True
                for k in range(4):
                    position[i, k] = angle_from(low[k], d[k])
                    if position[i, k] > high[k]:
                        inside = False
                measures[i] = measure
                alive[i] = inside
                if inside:
                    count += 1
    return count


@kernel
def fill_node(horizontal: bool, C: Array, grid: Grid, index: int, d: Array) -> None:
    """d (4,) <- the node of that index, as `fill_nodes` has it."""
    G = grid.cosines.shape[0]
    chart = index // (2 * G)
    g = index % G
    V = np.empty((3, 3))
    view(horizontal, C, V)
    side = -1.0 if horizontal else 1.0
    node_pose(side, V, chart, -math.pi + TURN / G * g, grid.cosines[g], grid.sines[g], d)
    if index // G % 2 == 1:
        other_branch(chart, d)
    for k in range(4):
        d[k] = angle_from(grid.low[k], d[k])
