"""A path inside every limit after any other, sample by sample."""

import numpy as np

from fullpose._jit import kernel
from fullpose._typing import Array
from fullpose.limits import ACCELERATION, MAX, MIN, approach_rate, empty_box, limit_box


@kernel
def follow(table: Array, time: Array, target: Array, x: Array) -> None:
    """x (n, 4) <- a path inside the limits (`limit_table`) after target (n, 4) [rad], as fast as it can brake."""
    n = time.shape[0]
    v = np.zeros(4)
    box = empty_box()
    for i in range(4):
        x[0, i] = min(max(target[0, i], table[MIN, i]), table[MAX, i])
    past = 0.0
    for k in range(1, n):
        h = time[k] - time[k - 1]
        limit_box(table, x[k - 1], v, past, h, box)
        for i in range(4):
            gap = target[k - 1, i] - x[k - 1, i]
            speed = approach_rate(abs(gap), 0.5 * table[ACCELERATION, i], h)
            wanted = target[k, i] - target[k - 1, i] + (speed if gap > 0.0 else -speed) * h
            x[k, i] = min(max(x[k - 1, i] + wanted, box.lo[i]), box.hi[i])
            v[i] = (x[k, i] - x[k - 1, i]) / h
        past = h
