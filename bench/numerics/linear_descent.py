"""The least tolerance next to a path by linear programmes, every sample's angles free: a reference of another kind.

Unknowns are the angles themselves. Rates and accelerations are differences of samples, as the verdict takes them; the
attitude's errors are SciPy's rotation vectors, their derivatives are central differences, and |e| <= tau is cut by
planes until no sample is over it (Kelley 1960). The programmes are solved by HiGHS (Huangfu and Hall 2018). Nothing is
shared with the planner: no spline, no quadratic programme, no Gauss-Newton curvature.
"""

import math
from dataclasses import dataclass, replace

import numpy as np
from scipy import sparse
from scipy.optimize import linprog
from scipy.spatial.transform import Rotation

from bench.numerics.infeasible_flights import Case
from bench.numerics.shooting import limits
from fullpose._typing import Array

STEP = 1e-6  # [rad] of a central difference
TRUST = 0.4  # [rad] that a sample moves in one programme at most
LEAST_TRUST = 1e-5  # [rad]
ITERATIONS = 40
SETTLED = 1e-3  # share of tau below which an improvement is none
STALE = 2  # of those in a row end it
ROWS_FROM = 0.6  # of the largest error: samples below it less what they can gain have no row
CUTS = 2  # rounds of cutting planes in one iteration
OVER = 2e-3  # of tau: an error that is over it by more is cut


@dataclass(frozen=True)
class Descent:
    """A path (n, 4) [rad] inside every limit and its largest error [rad]."""

    path: Array
    tolerance: float


@dataclass(frozen=True)
class _Local:
    """The path and its errors, linearised."""

    x: Array  # (n, 4)
    e: Array  # (n, 3)
    J: Array  # (n, 3, 4)
    trust: float


def rotation_vectors(case: Case, x: Array) -> Array:
    """(n, 3) [rad] from the attitude to what frames x (n, 4) [rad] give, by SciPy."""
    turned = Rotation.identity(len(x))
    for i in case.rig.geometry.frames:
        turned = turned * Rotation.from_rotvec(x[:, i, None] * np.eye(3)[case.rig.geometry.axes[i]])
    wanted = Rotation.from_matrix(np.swapaxes(case.attitude, 1, 2))
    return np.asarray((turned.inv() * wanted).as_rotvec())


def largest(case: Case, x: Array) -> float:
    """[rad]"""
    return float(np.linalg.norm(rotation_vectors(case, x), axis=1).max())


def descended_linearly(case: Case, path: Array, enough: float = 0.0) -> Descent | None:
    """From path (n, 4) [rad], near the limits: the least tolerance next to it; None where the limits are not met.

    A descent that will not come below `enough` [rad] is not gone on with.
    """
    x, rows = path, _limit_rows(case)
    moved = _programme(case, replace(_linearised(case, x, TRUST), trust=2.0 * TRUST), rows)
    if moved is None:
        return None
    x = moved
    now, trust, stale = largest(case, x), TRUST, 0
    for count in range(ITERATIONS):
        local = _linearised(case, x, trust)
        while trust > LEAST_TRUST:
            moved = _programme(case, replace(local, trust=trust), rows)
            after = math.inf if moved is None else largest(case, moved)
            if moved is not None and after < now:
                break
            trust *= 0.25
        else:
            break
        stale = stale + 1 if now - after < SETTLED * now else 0
        x, now, trust = moved, after, min(TRUST, 2.0 * trust)
        if stale >= STALE or (count >= 5 and now > 1.5 * enough > 0.0):
            break
    return Descent(x, now)


def _linearised(case: Case, x: Array, trust: float) -> _Local:
    J = np.zeros((len(x), 3, 4))
    for i in case.rig.geometry.frames:
        push = np.zeros(4)
        push[i] = STEP
        J[:, :, i] = (rotation_vectors(case, x + push) - rotation_vectors(case, x - push)) / (2.0 * STEP)
    J[np.abs(J).max(axis=(1, 2)) > 10.0] = 0.0  # across half a turn: no derivative there
    return _Local(x, rotation_vectors(case, x), J, trust)


def _limit_rows(case: Case) -> tuple[object, Array]:
    """Rows A x <= b of the rate and acceleration limits, x (n m,) of the frames that the rig has, frame fastest."""
    n, frames = len(case.time), list(case.rig.geometry.frames)
    _, _, rate, acceleration = (limit[frames] for limit in limits(case.rig))
    h = float(case.time[1] - case.time[0])
    first = sparse.diags([-1.0, 1.0], [0, 1], shape=(n - 1, n)) / h
    second = sparse.diags([1.0, -2.0, 1.0], [0, 1, 2], shape=(n - 2, n)) / h**2
    one = sparse.vstack(
        [sparse.kron(first, sparse.diags(1.0 / rate)), sparse.kron(second, sparse.diags(1.0 / acceleration))]
    )
    both = sparse.vstack([one, -one], format="csr")
    return both, np.ones(both.shape[0])


def _programme(case: Case, local: _Local, rows: tuple[object, Array]) -> Array | None:
    """The path (n, 4) that the linearised errors make best inside the limits and the trust region; None: none."""
    frames = list(case.rig.geometry.frames)
    n, m = len(local.x), len(frames)
    A, b = rows
    low, high, rate, _ = limits(case.rig)
    bounds = np.empty((n, m, 2))
    bounds[:, :, 0] = np.maximum(local.x - local.trust, low)[:, frames] - local.x[:, frames]
    bounds[:, :, 1] = np.minimum(local.x + local.trust, high)[:, frames] - local.x[:, frames]
    bounds[:, :, 1] = np.maximum(bounds[:, :, 1], bounds[:, :, 0])
    if case.start is not None:
        bounds[0] = (case.start - local.x[0])[frames, None]
        if case.start_rate is not None:
            h = float(case.time[1] - case.time[0])
            bounds[1] = (case.start + h * np.clip(case.start_rate, -rate, rate) - local.x[1])[frames, None]
    room = b - A @ local.x[:, frames].ravel()
    size = np.linalg.norm(local.e, axis=1)
    watched = np.flatnonzero(size > ROWS_FROM * size.max() - 2.0 * local.trust)
    directions = [(watched, local.e[watched] / np.maximum(size[watched], 1e-12)[:, None])]
    every = np.append(bounds.reshape(-1, 2), [[0.0, np.inf]], axis=0)
    cost = np.append(np.zeros(n * m), 1.0)
    best = None
    for _ in range(CUTS):
        which = np.concatenate([each for each, _ in directions])
        u = np.concatenate([each for _, each in directions])
        r = len(which)
        slope = np.einsum("kr,krp->kp", u, local.J[which][:, :, frames])
        columns = np.column_stack([which[:, None] * m + np.arange(m), np.full(r, n * m)])
        data = np.column_stack([slope, np.full(r, -1.0)])
        errors = sparse.csr_matrix((data.ravel(), columns.ravel(), np.arange(r + 1) * (m + 1)), shape=(r, n * m + 1))
        wide = sparse.hstack([A, sparse.csr_matrix((A.shape[0], 1))], format="csr")
        found = linprog(
            cost, sparse.vstack([wide, errors], format="csc"),
            np.concatenate([room, -np.einsum("kr,kr->k", u, local.e[which])]), bounds=every, method="highs-ipm",
            options={"time_limit": 10.0},
        )  # fmt: skip
        if found.x is None or found.status not in (0, 1):
            break
        step = np.zeros((n, 4))
        step[:, frames] = found.x[:-1].reshape(n, m)
        best = local.x + step
        predicted = local.e + np.einsum("krp,kp->kr", local.J, step)
        far = np.linalg.norm(predicted, axis=1)
        over = np.flatnonzero(far > found.x[-1] * (1.0 + OVER) + 1e-9)
        if not over.size:
            break
        directions.append((over, predicted[over] / far[over, None]))
    return best
