"""One step: the quadratic programme every method approximates, solved in closed form (mathematics, section 4).

    minimise 1/2 (x - d - g)^T W (x - d - g)   subject to   J (x - d) = e,   lo <= x <= hi

d the pose, e the increment of attitude [rad], g an increment of the frames that is wanted of its own (zero in the
papers). All solutions of J (x - d) = e lie on one line, x = d + p + n z; each bound cuts an interval of z. Where the
intervals have no point in common the limits win: `least_squares.box_least_squares` makes |J (x - d) - e| as small as
they allow. W is diagonal.
"""

import math
from typing import NamedTuple

import numpy as np

from fullpose._jit import inlined
from fullpose._typing import Array
from fullpose.least_squares import least_norm, squared_damping
from fullpose.limits import inside

# Below this a component of the null vector moves its frame by less than rounding does over any step.
PARALLEL = 1e-12


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


class Programme(NamedTuple):
    """The quadratic programme of one step, in the symbols of this module's head."""

    J: Array  # (3, 4) at d
    n: Array  # (4,) its unit null vector
    manipulability: float  # sqrt(det J J^T)
    weight: Array  # (4,) the diagonal of W
    d: Array  # (4,) [rad]
    g: Array  # (4,) [rad]
    e: Array  # (3,) [rad]
    lo: Array  # (4,) [rad] of the pose
    hi: Array
    tolerance: Array  # (4,) [rad] how far outside a frame may round


@inlined
def quadratic_step(programme: Programme, x: Array) -> bool:
    """x (4,) <- the programme's solution; false where it has none, x being then the one that shares the excess."""
    J, n, manipulability, weight, d, g, e, lo, hi, tolerance = programme
    least_norm(J, weight, g, e, squared_damping(manipulability), x)
    for i in range(4):
        x[i] += d[i]
    # z = 0 is the least weighted distance from d + g along the line.
    z_min, z_max = null_interval(x, n, lo, hi, tolerance)
    z = clamp(0.0, z_min, z_max)
    for i in range(4):
        x[i] += n[i] * z
    return z_min <= z_max or inside(x, lo, hi, tolerance)
