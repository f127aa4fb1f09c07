"""The least tolerance next to a path: the least largest attitude error inside every limit (mathematics, section 13).

Sequential quadratic programming on the coefficients of all frames. With e the rotation vector of F C^T and J the
Jacobian, |e|^2 <= tau has the gradient 2 J^T e and, by Gauss-Newton, the Hessian 2 J^T J, weighed by the multipliers of
the programme before (Nocedal and Wright, Numerical Optimization, section 18.1). The limits are linear and met by every
iterate; a step is cut until the merit falls.
"""

from dataclasses import dataclass

import numpy as np
from scipy import sparse

from fullpose._typing import Array, Integers
from fullpose.trajectory.bspline import WIDTH
from fullpose.trajectory.qp import Matrices, Matrix, Solver, Status
from fullpose.trajectory.tolerance_mesh import DAMPING, Mesh

TRUST = 0.6  # [rad] a coefficient moves in one iteration at most
FRACTIONS = (1.0, 0.5, 0.25, 0.1)  # of a step that are tried
SHRINK = 0.2  # of the trust region where none of them pays
SETTLED = 1e-3  # share of the merit below which an improvement is none
STILL = 1e-7  # [rad] a step below which nothing moves
SMOOTH = 1e-4  # of the mean acceleration squared as a share of its limit
ROWS_FROM = 0.2  # share of the largest error squared from which a sample has a row
FLATTEST = 1e-12  # [rad^2] an error squared that errors are measured against at least
PEAKED = 8  # power of the errors squared that the first multipliers follow
FAR = 1e3  # of tau: beyond every error
RIGID = 1e-9  # curvature of tau, which is linear


@dataclass(frozen=True)
class Aim:
    """tau >= floor costs `largest` a unit, the mean squared error `mean` a unit: what the two stages differ in."""

    largest: float
    mean: float
    floor: float = 0.0  # [rad^2]


TOLERANCE = Aim(largest=1.0, mean=0.02)  # the least tolerance first


def within(tolerance: float) -> Aim:
    """The least mean squared error inside a tolerance [rad]."""
    return Aim(largest=100.0, mean=1.0, floor=tolerance**2)


@dataclass(frozen=True)
class Minimax:
    """Unknowns of the mesh and their largest error [rad] at its samples."""

    unknowns: Array
    tolerance: float
    multipliers: Array | None = None  # (k,) and the trust region [rad], for who goes on from here
    trust: float = TRUST
    settled: bool = False  # nothing is gained by going on


@dataclass(frozen=True)
class _Iterate:
    """Where the programme is linearised; errors squared count in `unit` [rad^2]."""

    c: Array
    angle: Array  # (k,) [rad]
    unit: float
    multipliers: Array  # (k,)


def begun(mesh: Mesh, c: Array) -> Minimax:
    """Unknowns c inside the limits, to begin from."""
    return Minimax(c, float(mesh.errors(c).max()))


def minimax(mesh: Mesh, begin: Minimax, aim: Aim, solver: Solver, iterations: int) -> Minimax:
    """From unknowns inside the limits, or on from where another call for the same aim and mesh ended: the least of the
    aim next to them."""
    c = begin.unknowns

    def merit(angle: Array, c: Array, unit: float) -> float:
        largest = max(0.0, float(angle.max()) ** 2 - aim.floor)
        mean = float(np.mean(angle**2))
        return (aim.largest * largest + aim.mean * mean) / unit + SMOOTH * _quadratic(mesh, c)

    angle = mesh.errors(c)
    share = np.maximum(angle**2 / max(float(angle.max()) ** 2, FLATTEST), 1e-9) ** PEAKED
    multipliers = aim.largest * share / share.sum() if aim.floor == 0.0 else np.zeros(len(angle))
    if begin.multipliers is not None and len(begin.multipliers) == len(angle):
        multipliers = begin.multipliers
    trust, settled = begin.trust, True
    for _ in range(iterations):
        at = _Iterate(c, angle, max(float(angle.max()) ** 2, FLATTEST), multipliers)
        answer = _step(mesh, at, aim, trust, solver)
        if answer is None:
            break
        step, multipliers = answer
        now = merit(angle, c, at.unit)
        for fraction in FRACTIONS:
            moved = c + fraction * step
            after = mesh.errors(moved)
            gain = now - merit(after, moved, at.unit)
            if gain > 0.0:
                break
        else:
            trust *= SHRINK
            if trust < STILL:
                break
            continue
        c, angle = moved, after
        shift = fraction * float(np.abs(step).max())
        trust = min(TRUST, 2.0 * trust) if fraction == 1.0 else max(fraction, 0.5) * trust
        if gain < SETTLED * now or shift < STILL:
            break
    else:
        settled = False
    return Minimax(c, float(angle.max()), multipliers, trust, settled)


def _quadratic(mesh: Mesh, c: Array) -> float:
    """The mean acceleration squared as a share of its limit, of unknowns c (n,)."""
    return float(c @ _times(mesh.smoothness, c))


def _times(bands: Array, c: Array) -> Array:
    """The symmetric matrix of upper bands (n, w) times c (n,)."""
    n = len(c)
    product = bands[:, 0] * c
    for b in np.flatnonzero(bands[:, 1:].any(axis=0)) + 1:
        product[: n - b] += bands[: n - b, b] * c[b:]
        product[b:] += bands[: n - b, b] * c[: n - b]
    return np.asarray(product)


def _step(
    mesh: Mesh, at: _Iterate, aim: Aim, trust: float, solver: Solver
) -> tuple[Array, Array] | None:  # fmt: skip
    """(the step (n,), the multipliers (k,)) of the quadratic programme; None where the solver has none."""
    n, k, limits = mesh.unknowns, len(at.angle), mesh.limits
    e, J = mesh.model(at.c)
    mean = 2.0 * aim.mean / (k * at.unit)
    H = mesh.normal_bands(J, 2.0 * at.multipliers / at.unit + mean) + 2.0 * SMOOTH * mesh.smoothness
    H[:, 0] += DAMPING
    gradients = _gradients(mesh, e, J)  # (k, WIDTH, m)
    square = at.angle**2
    rows = np.flatnonzero(square >= ROWS_FROM * max(float(square.max()), aim.floor))
    g = np.zeros((mesh.spline.size, len(mesh.columns)))
    np.add.at(g, mesh.spline.first[:, None] + np.arange(WIDTH), mean * gradients)
    g = g.ravel() + 2.0 * SMOOTH * _times(mesh.smoothness, at.c)
    room = np.maximum(limits.h - limits.G @ at.c, 0.0)
    answer = solver(
        Matrices(
            P=mesh.upper(H, RIGID),
            q=np.append(g, aim.largest),
            G=_rows(mesh, (2.0 / at.unit) * gradients, rows),
            h=np.concatenate([-square[rows] / at.unit, room]),
            A=None if mesh.A is None else sparse.hstack([mesh.A, _column(mesh.A)], format="csc"),
            b=None if mesh.A is None else np.zeros(mesh.A.shape[0]),
            lower=np.append(np.minimum(np.maximum(-trust, limits.low - at.c), 0.0), aim.floor / at.unit),
            upper=np.append(np.maximum(np.minimum(trust, limits.high - at.c), 0.0), FAR + aim.floor / at.unit),
        )
    )
    if answer.status is Status.FAILED or not mesh.keeps_limits(at.c + answer.x[:n]):
        return None
    multipliers = np.zeros(k)
    multipliers[rows] = np.maximum(answer.duals[: len(rows)], 0.0)
    return answer.x[:n], multipliers


def _column(rows: Matrix) -> Matrix:
    """Of zeros: the rows do not depend on tau."""
    return sparse.csc_matrix((rows.shape[0], 1))


def _gradients(mesh: Mesh, e: Array, J: Array) -> Array:
    """(k, WIDTH, m): J^T e of each sample by the unknowns that it depends on."""
    push = np.einsum("kr,krp->kp", e, J[:, :, mesh.columns])
    return np.asarray(mesh.spline.values[:, :, None] * push[:, None, :])


def _rows(mesh: Mesh, gradients: Array, rows: Integers) -> Matrix:
    """(r + limits, n + 1): gradients (k, WIDTH, m) of the samples `rows` with -1 at tau, then the limits."""
    r, m, n = len(rows), len(mesh.columns), mesh.unknowns
    width = WIDTH * m
    limits = mesh.limits.G
    column = (mesh.spline.first[rows] * m)[:, None] + np.arange(width + 1)
    column[:, -1] = n
    data = np.column_stack([gradients[rows].reshape(r, width), np.full(r, -1.0)])
    start = np.arange(r + 1) * (width + 1)
    stacked: Matrix = sparse.csr_matrix(
        (
            np.concatenate([data.ravel(), limits.data]),
            np.concatenate([column.ravel(), limits.indices]),
            np.concatenate([start, limits.indptr[1:] + start[-1]]),
        ),
        shape=(r + limits.shape[0], n + 1),
    )
    return stacked.tocsc()
