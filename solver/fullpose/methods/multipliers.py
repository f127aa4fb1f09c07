"""The augmented Lagrange multiplier iteration of `alm`: the minimum of M, the updates, and when it has settled.

mathematics, section 5. The symbols are those of `alm`.
"""

from typing import Protocol

import numpy as np

from fullpose._jit import inlined, inner
from fullpose._typing import Array
from fullpose.least_squares import solve_symmetric
from fullpose.methods.state import Flight

MOST_CHANGES = 5  # of the active bounds between two updates of the multipliers


class Multipliers(Protocol):
    """The iteration's constants and its unknowns, as `MULTIPLIERS` lays them out."""

    mode: int  # `alm.Mode` by its place
    penalty: float
    growth: float
    max_penalty: float
    residual: float
    max_iterations: int
    equality: Array  # (3,) lambda
    lower: Array  # (4,) mu of the lower bounds
    upper: Array
    products: Array  # (4, 5) J^T J and J^T e
    system: Array  # (4, 5) K and b


MULTIPLIERS = np.dtype(
    (
        np.record,
        np.dtype(
            [
                ("mode", "i8"), ("penalty", "f8"), ("growth", "f8"), ("max_penalty", "f8"), ("residual", "f8"),
                ("max_iterations", "i8"), ("equality", "f8", 3), ("lower", "f8", 4), ("upper", "f8", 4),
                ("products", "f8", (4, 5)), ("system", "f8", (4, 5)),
            ],
            align=True,
        ),
    )
)  # fmt: skip


@inlined
def active_bounds(own: Multipliers, r: float, lo: Array, hi: Array, s: Array) -> int:
    """Base 3, a digit a frame: no bound's term in M counts at s, the lower one's does (1), the upper one's (2)."""
    active = 0
    for i in range(3, -1, -1):
        active *= 3
        if own.upper[i] + r * (s[i] - hi[i]) > 0.0:
            active += 2
        elif own.lower[i] + r * (lo[i] - s[i]) > 0.0:
            active += 1
    return active


@inlined
def minimum_of_m(flight: Flight, own: Multipliers, r: float, active: int) -> bool:
    """step <- the minimum of M at penalty r with the bounds of `active`; false where it has none."""
    J = flight.J
    P = own.products
    K = own.system
    rest = active
    for i in range(4):
        weight = flight.weight[i]
        K[i, 4] = weight * flight.increment[i] + r * P[i, 4]
        for k in range(3):
            K[i, 4] -= J[k, i] * own.equality[k]
        for j in range(i + 1):
            K[i, j] = r * P[i, j]
        K[i, i] += weight
        if rest % 3 == 1:
            K[i, i] += r
            K[i, 4] += r * flight.lo[i] + own.lower[i]
        elif rest % 3 == 2:
            K[i, i] += r
            K[i, 4] += r * flight.hi[i] - own.upper[i]
        rest //= 3
    if not solve_symmetric(K, K[:, 4], 4):
        return False
    for i in range(4):
        flight.step[i] = K[i, 4]
    return True


@inlined
def update_multipliers(flight: Flight, own: Multipliers, r: float) -> float:
    """Move lambda and mu up their gradients; returns the largest violation of the constraints and complementarity."""
    J = flight.J
    s = flight.step
    violation = 0.0
    for k in range(3):
        h = J[k, 0] * s[0] + J[k, 1] * s[1] + J[k, 2] * s[2] + J[k, 3] * s[3] - flight.e[k]
        own.equality[k] += r * h
        violation = max(violation, abs(h))
    for i in range(4):
        # Complementarity: a bound is kept, and its multiplier is zero unless it is met.
        above = s[i] - flight.hi[i]
        below = flight.lo[i] - s[i]
        violation = max(violation, abs(max(above, -own.upper[i] / r)), abs(max(below, -own.lower[i] / r)))
        own.upper[i] = max(0.0, own.upper[i] + r * above)
        own.lower[i] = max(0.0, own.lower[i] + r * below)
    return violation


@inner
def multiplier_step(flight: Flight, own: Multipliers) -> int:
    """step <- the one by the augmented multiplier method; returns the iterations, negative where it has not settled.

    Of the flight J, e, increment and weights are read, and lo, hi, which are bounds of the step here.
    """
    J = flight.J
    e = flight.e
    s = flight.step
    r = own.penalty
    for i in range(3):
        own.equality[i] = 0.0
    for i in range(4):
        own.lower[i] = 0.0
        own.upper[i] = 0.0
        s[i] = 0.0
        own.products[i, 4] = J[0, i] * e[0] + J[1, i] * e[1] + J[2, i] * e[2]
        for j in range(i + 1):
            own.products[i, j] = J[0, i] * J[0, j] + J[1, i] * J[1, j] + J[2, i] * J[2, j]
    active = active_bounds(own, r, flight.lo, flight.hi, s)
    changes = 0
    for iteration in range(1, own.max_iterations + 1):
        if not minimum_of_m(flight, own, r, active):
            return -iteration
        # Multipliers answer for a minimum of M only where the bounds reckoned with are those that count there.
        before = active
        active = active_bounds(own, r, flight.lo, flight.hi, s)
        if active != before and changes < MOST_CHANGES:
            changes += 1
            continue
        changes = 0
        if update_multipliers(flight, own, r) <= own.residual:
            return iteration
        r = min(r * own.growth, own.max_penalty)
        active = active_bounds(own, r, flight.lo, flight.hi, s)
    return -int(own.max_iterations)
