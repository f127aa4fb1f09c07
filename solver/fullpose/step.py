"""One step: the quadratic programme every method approximates, solved in closed form (mathematics, section 4).

    minimise 1/2 (x - d - g)^T W (x - d - g)   subject to   J (x - d) = e,   lo <= x <= hi

d the pose, e the increment of attitude [rad], g an increment of the frames that is wanted of its own (zero in the
papers). All solutions of J (x - d) = e lie on one line, x = d + p + n z; each bound cuts an interval of z. Where the
intervals have no point in common the limits win: `box_least_squares` makes |J (x - d) - e| as small as they allow.
W is diagonal. No LAPACK: the systems are 3x3 and 4x4.
"""

import math

import numpy as np

from fullpose._jit import inlined, inner
from fullpose._typing import Array
from fullpose.limits import inside

# Damping (Chiaverini) where the Jacobian has all but lost its third direction; sqrt(det J J^T) is at most 2.
DAMPED_BELOW = 1e-4
MAX_DAMPING = 1e-4
# Below this a component of the null vector moves its frame by less than rounding does over any step.
PARALLEL = 1e-12
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
def least_norm(J: Array, weight: Array, g: Array, e: Array, damping: float, p: Array) -> None:
    """p <- g + W^-1 J^T (J W^-1 J^T + damping I)^-1 (e - J g), the step of least weighted distance from g.

    J (3, 4); weight, g, p (4,); e (3,). The 3x3 inverse is the adjugate's.
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
    c00 = a11 * a22 - a12 * a12
    c01 = a02 * a12 - a01 * a22
    c02 = a01 * a12 - a02 * a11
    c11 = a00 * a22 - a02 * a02
    c12 = a01 * a02 - a00 * a12
    c22 = a00 * a11 - a01 * a01
    scale = 1.0 / (a00 * c00 + a01 * c01 + a02 * c02)
    y0 = scale * (c00 * r0 + c01 * r1 + c02 * r2)
    y1 = scale * (c01 * r0 + c11 * r1 + c12 * r2)
    y2 = scale * (c02 * r0 + c12 * r1 + c22 * r2)
    for i in range(4):
        p[i] = g[i] + (J[0, i] * y0 + J[1, i] * y1 + J[2, i] * y2) / weight[i]


@inlined
def null_interval(y: Array, n: Array, lo: Array, hi: Array, tolerance: Array) -> tuple[float, float]:
    """(z_min, z_max) with lo <= y + n z <= hi; z_min > z_max where there is none. All (4,).

    A frame that the self-motion does not move is given the tolerance.
    """
    z_min = -np.inf
    z_max = np.inf
    for i in range(4):
        if abs(n[i]) > PARALLEL:
            a = (lo[i] - y[i]) / n[i]
            b = (hi[i] - y[i]) / n[i]
            if a > b:
                a, b = b, a
            z_min = max(z_min, a)
            z_max = min(z_max, b)
        elif y[i] < lo[i] - tolerance[i] or y[i] > hi[i] + tolerance[i]:
            return np.inf, -np.inf
    return z_min, z_max


@inlined
def clamp(z: float, z_min: float, z_max: float) -> float:
    """z inside [z_min, z_max]; the middle, which shares the excess, where the interval is empty but finite."""
    if z_min <= z_max:
        return min(max(z, z_min), z_max)
    if math.isinf(z_min) or math.isinf(z_max):
        return z
    return 0.5 * (z_min + z_max)


@inner
def box_least_squares(J: Array, e: Array, damping: Array, g: Array, lo: Array, hi: Array, s: Array, A: Array) -> int:
    """s <- the step in [lo, hi] with the least |J s - e|^2 + sum damping (s - g)^2; returns the costliest bound.

    J (3, 4), e (3,); damping, g, lo, hi, s (4,) are of the step, not of the pose; A (4, 5) is room to work in.
    Returns 0 where no bound holds the step back, else 1 + 2 frame + (1 at the upper bound). The damping is positive, so
    the minimum is unique: the first active set that satisfies the Karush-Kuhn-Tucker conditions is the answer. Tried
    in the order of the active-set iteration, then all 81, since that may cycle.
    """
    b = A[:, 4]
    best = np.inf
    best_binding = 0
    t0 = t1 = t2 = t3 = 0.0
    side = 0  # base 3: the frame is free, at lo, at hi
    for attempt in range(8 + ACTIVE_SETS):
        if attempt >= 8:
            side = attempt - 8
        # Solve for the free frames with the others on their bounds.
        m = 0
        rest = side
        for i in range(4):
            at = rest % 3
            rest //= 3
            s[i] = 0.0 if at == 0 else lo[i] if at == 1 else hi[i]
        if not (math.isfinite(s[0]) and math.isfinite(s[1]) and math.isfinite(s[2]) and math.isfinite(s[3])):
            continue
        r0 = e[0]
        r1 = e[1]
        r2 = e[2]
        for i in range(4):
            r0 -= J[0, i] * s[i]
            r1 -= J[1, i] * s[i]
            r2 -= J[2, i] * s[i]
        rest = side
        for i in range(4):
            if rest % 3 == 0:
                b[m] = J[0, i] * r0 + J[1, i] * r1 + J[2, i] * r2 + damping[i] * g[i]
                k = 0
                other = side
                for j in range(i + 1):
                    if other % 3 == 0:
                        A[m, k] = J[0, i] * J[0, j] + J[1, i] * J[1, j] + J[2, i] * J[2, j]
                        k += 1
                    other //= 3
                A[m, m] += damping[i]
                m += 1
            rest //= 3
        if not solve_symmetric(A, b, m):
            continue
        m = 0
        rest = side
        for i in range(4):
            if rest % 3 == 0:
                s[i] = b[m]
                m += 1
            rest //= 3
        # Where are the conditions broken? Free frames outside their box, bound ones that are pulled inward.
        r0 = -e[0]
        r1 = -e[1]
        r2 = -e[2]
        for i in range(4):
            r0 += J[0, i] * s[i]
            r1 += J[1, i] * s[i]
            r2 += J[2, i] * s[i]
        optimal = True
        following = 0
        power = 1
        binding = 0
        strongest = 0.0
        rest = side
        for i in range(4):
            at = rest % 3
            rest //= 3
            slope = J[0, i] * r0 + J[1, i] * r1 + J[2, i] * r2 + damping[i] * (s[i] - g[i])
            if at == 0:
                if s[i] < lo[i]:
                    optimal = False
                    at = 1
                elif s[i] > hi[i]:
                    optimal = False
                    at = 2
            elif (at == 1 and slope < -1e-18) or (at == 2 and slope > 1e-18):
                if lo[i] < hi[i]:
                    optimal = False
                    at = 0
            elif abs(slope) > strongest:
                strongest = abs(slope)
                binding = 1 + 2 * i + (at - 1)
            following += power * at
            power *= 3
        if optimal:
            return binding
        side = following
        # Where rounding keeps every set from passing, the best of them inside the box is the answer.
        cost = 0.0
        for i in range(4):
            s[i] = min(max(s[i], lo[i]), hi[i])
            cost += damping[i] * (s[i] - g[i]) ** 2
        for k in range(3):
            gap = J[k, 0] * s[0] + J[k, 1] * s[1] + J[k, 2] * s[2] + J[k, 3] * s[3] - e[k]
            cost += gap * gap
        if cost < best:
            best = cost
            best_binding = binding
            t0, t1, t2, t3 = s[0], s[1], s[2], s[3]
    s[0], s[1], s[2], s[3] = t0, t1, t2, t3
    return best_binding


@inlined
def quadratic_step(
    J: Array,
    n: Array,
    manipulability: float,
    weight: Array,
    d: Array,
    g: Array,
    e: Array,
    lo: Array,
    hi: Array,
    tolerance: Array,
    x: Array,
) -> bool:
    """x <- the programme's solution; false where no x satisfies it, x being then the one that shares the excess.

    J (3, 4) at d, n its unit null vector (4,), manipulability = sqrt(det J J^T), e (3,); the others (4,).
    """
    least_norm(J, weight, g, e, squared_damping(manipulability), x)
    for i in range(4):
        x[i] += d[i]
    # z = 0 is the least weighted distance from d + g along the line.
    z_min, z_max = null_interval(x, n, lo, hi, tolerance)
    z = clamp(0.0, z_min, z_max)
    for i in range(4):
        x[i] += n[i] * z
    return z_min <= z_max or inside(x, lo, hi, tolerance)
