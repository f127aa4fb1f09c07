"""A stretch of a flight as the least tolerance sees it: samples, splines of all frames, limits, and what is fixed."""

from dataclasses import dataclass, replace

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
    end_rows,
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

    def normal_matrix(self, J: Array, weight: Array) -> Matrix:
        """Sum of weight (k,) J^T J over the samples, J (k, 3, 4), of the unknowns."""
        n, width = self.unknowns, min(WIDTH * len(self.columns), self.unknowns)
        bands = np.zeros((n, WIDTH * len(self.columns)))
        normal_bands(self.spline.first, self.spline.values, J, weight, self.columns, bands)
        diagonals = [bands[: n - b, b] for b in range(width)]
        upper: Matrix = sparse.diags(diagonals, list(range(width)), shape=(n, n), format="csr")
        return upper + sparse.triu(upper, 1).T

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
    P = mesh.normal_matrix(J, np.full(k, 2.0 / k)) + near * (B.T @ B) + DAMPING * sparse.identity(mesh.unknowns)
    target, J = path[:, mesh.columns], J[:, :, mesh.columns]
    push = np.einsum("krp,krq,kq->kp", J, J, target) * (2.0 / k) + near * target
    limits = mesh.limits
    answer = problem.solver(
        Matrices(P.tocsc(), -(B.T @ push.ravel()), limits.G.tocsc(), limits.h, mesh.A, mesh.b, limits.low, limits.high)
    )
    if answer.status is Status.FAILED:
        return None
    c = np.clip(answer.x, limits.low, limits.high)
    return c if mesh.keeps_limits(c) else None
