"""Least squares of a step's 3 x 4 systems: of least norm, damped next to the singularity, and inside a box.

No LAPACK: the systems are of 3 or 4 unknowns and are solved where they are built.
"""

import math
from typing import NamedTuple

import numpy as np

from fullpose._jit import inlined, inner
from fullpose._typing import Array

# Damping (Chiaverini) where the Jacobian has all but lost its third direction; sqrt(det J J^T) is at most 2.
DAMPED_BELOW = 1e-4
MAX_DAMPING = 1e-4
CYCLES = 8  # steps of the active-set iteration before all sets are tried
ACTIVE_SETS = 81  # each of four frames free, at its lower or at its upper bound


@inlined
def squared_damping(manipulability: float) -> float:
    """s^2 of the damped inverse, from sqrt(det J J^T): zero but next to the singularity."""
    if manipulability >= DAMPED_BELOW:
        return 0.0
    ratio = manipulability / DAMPED_BELOW
    return MAX_DAMPING * MAX_DAMPING * (1.0 - ratio * ratio)


@inlined
def solve_symmetric(A: Array, b: Array, n: int) -> bool:
    """b <- A^-1 b by A = L D L^T, in place in the lower triangle of A; false where A is not positive definite. n <= 4.

    Row i of the triangle is left as L_ij D_j and 1 / D_i: no roots and one division a row, which are what takes long.
    """
    for i in range(n):
        for j in range(i):
            for k in range(j):
                A[i, j] -= A[i, k] * A[j, k] * A[k, k]
        pivot = A[i, i]
        for k in range(i):
            pivot -= A[i, k] * A[i, k] * A[k, k]
        if not pivot > 0.0:
            return False
        A[i, i] = 1.0 / pivot
        for k in range(i):
            b[i] -= A[i, k] * A[k, k] * b[k]
    for i in range(n - 1, -1, -1):
        b[i] *= A[i, i]
        for k in range(i + 1, n):
            b[i] -= A[k, i] * A[i, i] * b[k]
    return True


@inlined
def gram(J: Array) -> tuple[float, ...]:
    """J J^T, J (3, 4): its upper triangle, row by row."""
    a00 = a01 = a02 = a11 = a12 = a22 = 0.0
    for i in range(4):
        a00 += J[0, i] * J[0, i]
        a01 += J[0, i] * J[1, i]
        a02 += J[0, i] * J[2, i]
        a11 += J[1, i] * J[1, i]
        a12 += J[1, i] * J[2, i]
        a22 += J[2, i] * J[2, i]
    return a00, a01, a02, a11, a12, a22


@inlined
def adjugate(a00: float, a01: float, a02: float, a11: float, a12: float, a22: float) -> tuple[float, ...]:
    """The adjugate of a symmetric 3x3 matrix, its upper triangle row by row, and the determinant."""
    c00 = a11 * a22 - a12 * a12
    c01 = a02 * a12 - a01 * a22
    c02 = a01 * a12 - a02 * a11
    c11 = a00 * a22 - a02 * a02
    c12 = a01 * a02 - a00 * a12
    c22 = a00 * a11 - a01 * a01
    return c00, c01, c02, c11, c12, c22, a00 * c00 + a01 * c01 + a02 * c02


@inlined
def least_norm(J: Array, weight: Array, g: Array, e: Array, damping: float, p: Array) -> None:
    """p <- g + W^-1 J^T (J W^-1 J^T + damping I)^-1 (e - J g), the step of least weighted distance from g.

    J (3, 4); weight, g, p (4,); e (3,).
    """
    a00 = damping
    a01 = 0.0
    a02 = 0.0
    a11 = damping
    a12 = 0.0
    a22 = damping
    r0 = e[0]
    r1 = e[1]
    r2 = e[2]
    for i in range(4):
        u = 1.0 / weight[i]
        j0 = J[0, i]
        j1 = J[1, i]
        j2 = J[2, i]
        a00 += u * j0 * j0
        a01 += u * j0 * j1
        a02 += u * j0 * j2
        a11 += u * j1 * j1
        a12 += u * j1 * j2
        a22 += u * j2 * j2
        r0 -= j0 * g[i]
        r1 -= j1 * g[i]
        r2 -= j2 * g[i]
    c00, c01, c02, c11, c12, c22, determinant = adjugate(a00, a01, a02, a11, a12, a22)
    scale = 1.0 / determinant
    y0 = scale * (c00 * r0 + c01 * r1 + c02 * r2)
    y1 = scale * (c01 * r0 + c11 * r1 + c12 * r2)
    y2 = scale * (c02 * r0 + c12 * r1 + c22 * r2)
    for i in range(4):
        p[i] = g[i] + (J[0, i] * y0 + J[1, i] * y1 + J[2, i] * y2) / weight[i]


class LeastSquares(NamedTuple):
    """What `box_least_squares` minimises, |J s - e|^2 + sum damping (s - g)^2 over lo <= s <= hi: of the step s."""

    J: Array  # (3, 4)
    e: Array  # (3,)
    damping: Array  # (4,) positive, so that the minimum is unique
    g: Array  # (4,)
    lo: Array  # (4,)
    hi: Array


@inlined
def minimum_of_free(problem: LeastSquares, active: int, s: Array, A: Array) -> bool:
    """s <- the minimum over the frames that are free in the active set, the others on their bounds.

    False where there is none, or a bound of the set is infinite. active, A: see `box_least_squares`.
    """
    J, e, damping, g, lo, hi = problem
    b = A[:, 4]
    rest = active
    for i in range(4):
        at = rest % 3
        rest //= 3
        s[i] = 0.0 if at == 0 else lo[i] if at == 1 else hi[i]
    if not (math.isfinite(s[0]) and math.isfinite(s[1]) and math.isfinite(s[2]) and math.isfinite(s[3])):
        return False
    r0 = e[0]
    r1 = e[1]
    r2 = e[2]
    for i in range(4):
        r0 -= J[0, i] * s[i]
        r1 -= J[1, i] * s[i]
        r2 -= J[2, i] * s[i]
    m = 0
    rest = active
    for i in range(4):
        if rest % 3 == 0:
            b[m] = J[0, i] * r0 + J[1, i] * r1 + J[2, i] * r2 + damping[i] * g[i]
            k = 0
            other = active
            for j in range(i + 1):
                if other % 3 == 0:
                    A[m, k] = J[0, i] * J[0, j] + J[1, i] * J[1, j] + J[2, i] * J[2, j]
                    k += 1
                other //= 3
            A[m, m] += damping[i]
            m += 1
        rest //= 3
    if not solve_symmetric(A, b, m):
        return False
    m = 0
    rest = active
    for i in range(4):
        if rest % 3 == 0:
            s[i] = b[m]
            m += 1
        rest //= 3
    return True


@inlined
def optimality(problem: LeastSquares, active: int, s: Array) -> tuple[int, int]:
    """(the active set itself where s satisfies the Karush-Kuhn-Tucker conditions, else the next one; costliest bound).

    The conditions are broken by free frames outside their box and by bound ones that are pulled inward.
    """
    J, e, damping, g, lo, hi = problem
    r0 = -e[0]
    r1 = -e[1]
    r2 = -e[2]
    for i in range(4):
        r0 += J[0, i] * s[i]
        r1 += J[1, i] * s[i]
        r2 += J[2, i] * s[i]
    following = 0
    power = 1
    binding = 0
    strongest = 0.0
    rest = active
    for i in range(4):
        at = rest % 3
        rest //= 3
        slope = J[0, i] * r0 + J[1, i] * r1 + J[2, i] * r2 + damping[i] * (s[i] - g[i])
        if at == 0:
            if s[i] < lo[i]:
                at = 1
            elif s[i] > hi[i]:
                at = 2
        elif (at == 1 and slope < -1e-18) or (at == 2 and slope > 1e-18):
            if lo[i] < hi[i]:
                at = 0
        elif abs(slope) > strongest:
            strongest = abs(slope)
            binding = 1 + 2 * i + (at - 1)
        following += power * at
        power *= 3
    return following, binding


@inlined
def clipped_cost(problem: LeastSquares, s: Array) -> float:
    """s <- cut off at the box; returns what it costs there."""
    J, e, damping, g, lo, hi = problem
    cost = 0.0
    for i in range(4):
        s[i] = min(max(s[i], lo[i]), hi[i])
        cost += damping[i] * (s[i] - g[i]) ** 2
    for k in range(3):
        gap = J[k, 0] * s[0] + J[k, 1] * s[1] + J[k, 2] * s[2] + J[k, 3] * s[3] - e[k]
        cost += gap * gap
    return cost


@inner
def box_least_squares(problem: LeastSquares, s: Array, A: Array) -> int:
    """s <- the step of the problem; returns the costliest bound. s (4,), A (4, 5) is room to work in.

    Returns 0 where no bound holds the step back, else 1 + 2 frame + (1 at the upper bound). The first active set that
    satisfies the Karush-Kuhn-Tucker conditions is the answer, the minimum being unique. Tried in the order of the
    active-set iteration, then all `ACTIVE_SETS`, since that may cycle. A set is a number of base 3, a digit a frame: it
    is free, at lo, at hi.
    """
    best = np.inf
    best_binding = 0
    t0 = t1 = t2 = t3 = 0.0
    active = 0
    for attempt in range(CYCLES + ACTIVE_SETS):
        if attempt >= CYCLES:
            active = attempt - CYCLES
        if not minimum_of_free(problem, active, s, A):
            continue
        following, binding = optimality(problem, active, s)
        if following == active:
            return binding
        active = following
        # Where rounding keeps every set from passing, the best of them inside the box is the answer.
        cost = clipped_cost(problem, s)
        if cost < best:
            best = cost
            best_binding = binding
            t0, t1, t2, t3 = s[0], s[1], s[2], s[3]
    s[0], s[1], s[2], s[3] = t0, t1, t2, t3
    return best_binding
