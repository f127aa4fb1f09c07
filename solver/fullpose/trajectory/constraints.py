"""The limits that a refinement keeps to, and their rows in its quadratic programme (mathematics, section 8)."""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from fullpose._typing import Array, Flags, Integers
from fullpose.rig import Rig
from fullpose.trajectory.bspline import Basis
from fullpose.trajectory.linearisation import ROW, limit_rows

NEAR = 0.6  # share of a limit from which its rows are in the programme at once


@dataclass(frozen=True)
class Limits:
    """The limits a refinement keeps to, arrays (4,): a rig's, less the reserve."""

    low: Array
    high: Array
    rate: Array
    acceleration: Array


def rig_limits(rig: Rig, reserve: float = 0.0) -> Limits:
    """The rig's limits with `reserve` (a share of them) unused; positions keep 1e-5 rad clear of their ends at most."""
    span = rig.position_max - rig.position_min
    clear = np.minimum(1e-5, 0.1 * span) if reserve > 0.0 else 0.0
    return Limits(
        rig.position_min + clear, rig.position_max - clear,
        rig.max_rate * (1.0 - reserve), rig.max_acceleration * (1.0 - reserve),
    )  # fmt: skip


class Rows(NamedTuple):
    """Rows of a quadratic programme, row c <= bound: see `linearisation.limit_rows`."""

    origin: Integers  # (r,)
    rows: Array  # (r, ROW)
    bound: Array  # (r,)
    tag: Integers  # (r,)


def rows_within_reach(
    time: Array, d: Array, n: Array, limits: Limits, basis: Basis, stride: int, flags: Flags, trust: float
) -> Rows:
    """The rows of limits that may matter to a step from d (m, 4) [rad] along n (m, 4), as many as there are."""
    room = 1024
    while True:
        out = Rows(np.empty(room, np.int64), np.empty((room, ROW)), np.empty(room), np.empty(room, np.int64))
        count = limit_rows(
            time, d, n, basis.first, basis.values, stride, flags, trust, limits.low, limits.high,
            limits.rate, limits.acceleration, NEAR, *out,
        )  # fmt: skip
        if count <= room:
            return Rows(out.origin[:count], out.rows[:count], out.bound[:count], out.tag[:count])
        room = count
