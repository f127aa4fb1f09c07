"""Kernels of the least tolerance: the attitude error of samples, its derivative, its Gauss-Newton model."""

import numpy as np

from fullpose._jit import kernel
from fullpose._typing import Array, Integers
from fullpose.kinematics import jacobian, payload_attitude, rotation_error
from fullpose.trajectory.bspline import WIDTH


@kernel
def attitude_model(axes: Integers, attitude: Array, d: Array, e: Array, J: Array) -> None:
    """e (n, 3) [rad] <- rotation vectors of F C^T, J (n, 3, 4) <- Jacobians, of d (n, 4) [rad], attitude (n, 3, 3)."""
    F = np.empty((3, 3))
    for k in range(d.shape[0]):
        payload_attitude(axes, d[k], F)
        rotation_error(F, attitude[k], e[k])
        jacobian(axes, d[k], J[k])


@kernel
def errors_at(axes: Integers, attitude: Array, d: Array, angle: Array) -> None:
    """angle (n,) [rad] <- geodesic errors of d (n, 4) [rad]."""
    F = np.empty((3, 3))
    e = np.empty(3)
    for k in range(d.shape[0]):
        payload_attitude(axes, d[k], F)
        angle[k] = rotation_error(F, attitude[k], e)


@kernel
def normal_bands(first: Integers, values: Array, J: Array, weight: Array, columns: Integers, H: Array) -> None:
    """H (size * m, WIDTH * m) upper bands <- sum of weight J^T J over samples; unknown m j + i is frame i's j-th.

    first (n,), values (n, WIDTH), J (n, 3, 4), weight (n,), columns (m,) of the frames that move.
    """
    m = columns.shape[0]
    for k in range(first.shape[0]):
        w = weight[k]
        if w == 0.0:
            continue
        for p in range(m):
            i = columns[p]
            for q in range(m):
                j = columns[q]
                dot = w * (J[k, 0, i] * J[k, 0, j] + J[k, 1, i] * J[k, 1, j] + J[k, 2, i] * J[k, 2, j])
                for a in range(WIDTH):
                    u = m * (first[k] + a) + p
                    for b in range(WIDTH):
                        v = m * (first[k] + b) + q
                        if v >= u:
                            H[u, v - u] += dot * values[k, a] * values[k, b]
