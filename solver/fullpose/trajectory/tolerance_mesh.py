"""A stretch of a flight as the least tolerance sees it: samples, splines of all frames, limits, and what is fixed."""

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from scipy import sparse

from fullpose._typing import Array, Integers
from fullpose.rig import Rig
from fullpose.trajectory.attitude_rows import attitude_model, errors_at, normal_bands
from fullpose.trajectory.bspline import WIDTH
from fullpose.trajectory.frame_spline import (
    ENDS,
    FrameSpline,
    LimitRows,
    difference_matrix,
    end_rows,
    finite_limits,
    frame_spline,
    free_columns,
    limit_rows,
)
from fullpose.trajectory.problem import Problem
from fullpose.trajectory.qp import Matrices, Matrix, Status

NEAR = 0.02  # of the distance from a path in angles beside the distance in attitude
DAMPING = 1e-7  # on the diagonal: what nothing else determines stays where it is
KEPT = 1e-6  # of a limit: coefficients that are over it by more are not inside


@dataclass(frozen=True)
class End:
    """What is fixed at an end of a stretch: a row of value, slope and bend (ENDS, 4), as many of them as there are."""

    values: Array  # (1..ENDS, 4) [rad, rad/s, rad/s^2]


@dataclass(frozen=True)
class Mesh:
    """The unknowns are the coefficients of the frames that move, frame fastest."""

    attitude: Array  # (k, 3, 3) of the samples that are looked at
    rig: Rig
    spline: FrameSpline  # at those samples
    limits: LimitRows
    columns: Integers  # (m,) of the frames that move
    resting: Array  # (4,) [rad] of those that do not
    A: Matrix | None = None  # A c = b
    b: Array | None = None

    @property
    def unknowns(self) -> int:
        """How many."""
        return self.spline.size * len(self.columns)

    def coefficients(self, c: Array) -> Array:
        """(size, 4) of the unknowns."""
        every = np.tile(self.resting, (self.spline.size, 1))
        every[:, self.columns] = c.reshape(-1, len(self.columns))
        return every

    def errors(self, c: Array) -> Array:
        """(k,) [rad] geodesic, at the samples."""
        angle = np.empty(len(self.attitude))
        errors_at(self.rig.axes, self.attitude, self.spline.at_samples(self.coefficients(c)), angle)
        return angle

    def model(self, c: Array) -> tuple[Array, Array]:
        """(e (k, 3) [rad], J (k, 3, 4)) at the samples."""
        return self.model_of(self.spline.at_samples(self.coefficients(c)))

    def model_of(self, path: Array) -> tuple[Array, Array]:
        """The same of a path (k, 4) [rad]."""
        e, J = np.empty((len(path), 3)), np.empty((len(path), 3, 4))
        attitude_model(self.rig.axes, self.attitude, path, e, J)
        return e, J

    def normal_bands(self, J: Array, weight: Array) -> Array:
        """Sum of weight (k,) J^T J over the samples, J (k, 3, 4), of the unknowns: upper bands (n, WIDTH m)."""
        bands = np.zeros((self.unknowns, WIDTH * len(self.columns)))
        normal_bands(self.spline.first, self.spline.values, J, weight, self.columns, bands)
        return bands

    @cached_property
    def smoothness(self) -> Array:
        """The mean acceleration squared as a share of its limit, a quadratic form: upper bands (n, WIDTH m)."""
        m, n = len(self.columns), self.unknowns
        acceleration = finite_limits(self.rig)[1][self.columns]
        bend = difference_matrix(self.spline.size, 2)
        D = sparse.kron(bend, sparse.diags(1.0 / (acceleration * self.spline.spacing**2)))
        form = ((D.T @ D) / self.spline.size).todia()
        bands = np.zeros((n, WIDTH * m))
        for offset, diagonal in zip(form.offsets, form.data, strict=True):
            if offset >= 0:
                bands[: n - offset, offset] = diagonal[offset:n]
        return bands

    @cached_property
    def pattern(self) -> tuple[Integers, Integers, Integers, Integers]:
        """Where bands go in compressed columns of an upper triangle: (row, band) of each entry, indices, indptr."""
        n, width = self.unknowns, WIDTH * len(self.columns)
        column = np.arange(n)[:, None]
        rows = column + np.arange(1 - width, 1)  # (n, width) of each column, downward
        kept = rows >= 0
        row = rows[kept]
        band = np.broadcast_to(np.arange(width - 1, -1, -1), rows.shape)[kept]
        return row, band, row.astype(np.int32), np.append(0, np.cumsum(kept.sum(axis=1))).astype(np.int32)

    def upper(self, bands: Array, last: float | None = None) -> Matrix:
        """The upper triangle of bands (n, WIDTH m), one more unknown after it with `last` on its diagonal."""
        row, band, indices, indptr = self.pattern
        data, n = bands[row, band], self.unknowns
        if last is not None:
            data, n = np.append(data, last), n + 1
            indices = np.append(indices, np.int32(n - 1))
            indptr = np.append(indptr, np.int32(indptr[-1] + 1))
        return sparse.csc_matrix((data, indices, indptr), shape=(n, n))

    def keeps_limits(self, c: Array) -> bool:
        """Whether unknowns (n,) are inside the limits, and meet what is fixed."""
        inside = (self.limits.G @ c - self.limits.h).max(initial=0.0) <= KEPT
        return bool(inside and (self.A is None or np.abs(self.A @ c - self.b).max() <= KEPT))


Ends = tuple[End | None, End | None]


def mesh_of(problem: Problem, knot: float, at: Integers, ends: Ends) -> tuple[Mesh, FrameSpline]:
    """(the mesh that looks at the samples `at`, the splines at all of them): knots about `knot` [s] apart."""
    rig = problem.rig
    spline = frame_spline(problem.time, knot)
    looked = replace(spline, first=spline.first[at], values=spline.values[at])
    columns = np.array(free_columns(rig), np.int64)
    resting = np.zeros(4)
    for i in set(rig.geometry.frames) - set(columns.tolist()):
        resting[i] = 0.5 * (rig.position_min[i] + rig.position_max[i])
    A, b = _fixed(spline, columns, ends)
    attitude = np.ascontiguousarray(problem.attitude[at])
    return Mesh(attitude, rig, looked, limit_rows(spline, rig), columns, resting, A, b), spline


def _fixed(spline: FrameSpline, columns: Integers, ends: Ends) -> tuple[Matrix, Array] | tuple[None, None]:
    """A, b of what is fixed at the ends; None where nothing is."""
    m, parts, values = len(columns), [], []
    for at_end, end in enumerate(ends):
        if end is None:
            continue
        rows = np.zeros((len(end.values), spline.size))
        rows[:, slice(-ENDS, None) if at_end else slice(0, ENDS)] = end_rows(spline.spacing)[: len(end.values)]
        unit = np.array([1.0, spline.spacing, spline.spacing**2])[: len(end.values), None]
        parts.append(sparse.kron(rows * unit, sparse.identity(m)))
        values.append((end.values[:, columns] * unit).ravel())
    if not parts:
        return None, None
    return sparse.vstack(parts, format="csr"), np.concatenate(values)


def inside_limits(problem: Problem, mesh: Mesh, path: Array) -> Array | None:
    """Unknowns inside the limits whose frames come nearest to path (k, 4) [rad], in attitude first; None: none."""
    k, m = len(path), len(mesh.columns)
    _, J = mesh.model_of(path)
    B = sparse.kron(mesh.spline.matrix, sparse.identity(m), format="csr")
    near = NEAR / k
    P = mesh.upper(mesh.normal_bands(J, np.full(k, 2.0 / k)))
    P = sparse.csc_matrix(P + sparse.triu(near * (B.T @ B)) + DAMPING * sparse.identity(mesh.unknowns))
    target, J = path[:, mesh.columns], J[:, :, mesh.columns]
    push = np.einsum("krp,krq,kq->kp", J, J, target) * (2.0 / k) + near * target
    limits = mesh.limits
    answer = problem.solver(
        Matrices(P, -(B.T @ push.ravel()), limits.G.tocsc(), limits.h, mesh.A, mesh.b, limits.low, limits.high)
    )
    if answer.status is Status.FAILED:
        return None
    c = np.clip(answer.x, limits.low, limits.high)
    return c if mesh.keeps_limits(c) else None
