"""All frames as cubic B-splines over time, and the limits as rows of their coefficients (mathematics, section 13).

The derivatives of a uniform B-spline are B-splines of the coefficients' differences, and a B-spline stays inside the
hull of its coefficients (de Boor, A Practical Guide to Splines, chapters IX to XI): coefficients inside the ranges,
their first, second and third differences inside the rate, acceleration and jerk limits, and the frames are inside. The
samples' differences, which the verdict takes, are averages of the derivatives, so they are inside too.
"""

from dataclasses import dataclass

import numpy as np
from scipy import sparse

from fullpose._typing import Array, Integers
from fullpose.rig import Rig
from fullpose.trajectory.bspline import WIDTH
from fullpose.trajectory.curve import LOCKED
from fullpose.trajectory.qp import Matrix

RESERVE = 1e-5  # share of a rate or acceleration limit left to the solver's tolerance
CLEAR = 1e-6  # [rad] likewise of a range
FASTEST = 50.0  # [rad/s] of a frame without a limit
SHARPEST = 50.0  # [1/s] a frame without an acceleration limit changes its rate by this times its limit, a second
ENDS = 3  # coefficients that carry value, slope and bend at an end


@dataclass(frozen=True)
class FrameSpline:
    """`size` coefficients a frame, `spacing` [s] from knot to knot; at sample k those from first[k] weigh values[k]."""

    spacing: float
    size: int
    first: Integers  # (n,)
    values: Array  # (n, WIDTH)

    def at_samples(self, coefficients: Array) -> Array:
        """The frames (n, 4) [rad] of coefficients (size, 4)."""
        return np.asarray(np.einsum("kb,kbi->ki", self.values, coefficients[self.first[:, None] + np.arange(WIDTH)]))

    @property
    def matrix(self) -> Matrix:
        """(n, size) from coefficients to samples."""
        n = len(self.first)
        rows = np.repeat(np.arange(n), WIDTH)
        columns = (self.first[:, None] + np.arange(WIDTH)).ravel()
        return sparse.csr_matrix((self.values.ravel(), (rows, columns)), shape=(n, self.size))


def frame_spline(time: Array, knot: float) -> FrameSpline:
    """The splines for samples at time (n,) [s], at least two, with knots about `knot` [s] apart."""
    n = len(time)
    span = float(time[-1] - time[0])
    pieces = min(max(1, round(span / knot)), n - 1)
    s = (time - time[0]) * (pieces / span)
    first = np.clip(np.floor(s).astype(np.int64), 0, pieces - 1)
    return FrameSpline(span / pieces, pieces + WIDTH - 1, first, cubic_values(s - first))


def cubic_values(u: Array) -> Array:
    """The four cubic B-splines (n, WIDTH) that are not zero at u (n,), the share of a piece that has passed."""
    v = 1.0 - u
    return np.stack([v**3, 3 * u**3 - 6 * u**2 + 4, 3 * v**3 - 6 * v**2 + 4, u**3], axis=1) / 6.0


def finite_limits(rig: Rig) -> tuple[Array, Array]:
    """The rates [rad/s] and accelerations [rad/s^2] (4,) that the frames keep to, those without a limit too."""
    rate = np.minimum(rig.max_rate, FASTEST)
    return rate, np.minimum(rig.max_acceleration, SHARPEST * rate)


def free_columns(rig: Rig) -> list[int]:
    """The frames that move."""
    return [i for i in rig.geometry.frames if rig.position_max[i] - rig.position_min[i] >= LOCKED]


@dataclass(frozen=True)
class LimitRows:
    """G c <= h and low <= c <= high of the coefficients of the frames that move, frame fastest."""

    G: Matrix
    h: Array
    low: Array
    high: Array


def limit_rows(spline: FrameSpline, rig: Rig) -> LimitRows:
    """The limits of a rig as rows that are divided by the limit."""
    columns = free_columns(rig)
    rate, acceleration = (limit[columns] for limit in finite_limits(rig))
    slope = difference_matrix(spline.size, 1)
    bend = difference_matrix(spline.size, 2)
    rows = sparse.vstack(
        [
            sparse.kron(slope, sparse.diags(1.0 / (rate * (1.0 - RESERVE) * spline.spacing))),
            sparse.kron(bend, sparse.diags(1.0 / (acceleration * (1.0 - RESERVE) * spline.spacing**2))),
        ]
    )
    limited = np.flatnonzero(np.isfinite(rig.max_jerk[columns]))
    if limited.size and spline.size > 3:
        share = 1.0 / (rig.max_jerk[columns][limited] * (1.0 - RESERVE) * spline.spacing**3)
        chosen = sparse.csr_matrix((share, (np.arange(limited.size), limited)), shape=(limited.size, len(columns)))
        rows = sparse.vstack([rows, sparse.kron(difference_matrix(spline.size, 3), chosen)])
    G = sparse.vstack([rows, -rows], format="csr")
    low, high = rig.position_min[columns] + CLEAR, rig.position_max[columns] - CLEAR
    return LimitRows(G, np.ones(G.shape[0]), np.tile(low, spline.size), np.tile(high, spline.size))


def difference_matrix(size: int, order: int) -> Matrix:
    """(size - order, size): differences of the given order between neighbouring coefficients."""
    D = sparse.identity(size, format="csr")
    for _ in range(order):
        D = D[1:] - D[:-1]
    return D


def end_rows(spacing: float) -> Array:
    """(ENDS, ENDS): value, slope and bend at an end, of the first or the last `ENDS` coefficients; knots `spacing` [s]
    apart."""
    h = spacing
    return np.array([[1.0, 4.0, 1.0], [-3.0 / h, 0.0, 3.0 / h], [6.0 / h**2, -12.0 / h**2, 6.0 / h**2]]) / 6.0
