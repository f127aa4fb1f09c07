"""The basis of the refinement's unknown, a displacement along the self-motion as a function of the sample.

A uniform cubic B-spline, twice differentiable, with knots no closer than the samples; for a handful of samples, the
samples themselves. Knots count samples, not seconds, so that neighbouring samples always share functions.
"""

from typing import NamedTuple

import numpy as np

from fullpose._typing import Array, Integers

WIDTH = 4  # functions that are not zero at one sample
FEW = 12  # samples, below which they are the unknowns themselves


class Basis(NamedTuple):
    """`size` functions; at sample k those from first[k] on have values[k]. The first and last PINNED of them carry the
    value and the first two derivatives at the ends."""

    size: int
    first: Integers  # (n,)
    values: Array  # (n, WIDTH)


PINNED = 3


def spline_basis(time: Array, knot: float) -> Basis:
    """The basis for samples at `time` (n,) [s], knots about `knot` [s] apart."""
    n = len(time)
    if n < FEW:
        values = np.zeros((n, WIDTH))
        first = np.minimum(np.arange(n), max(0, n - WIDTH))
        values[np.arange(n), np.arange(n) - first] = 1.0
        return Basis(max(n, WIDTH), first.astype(np.int64), values)
    pieces = min(max(2, round(float(time[-1] - time[0]) / knot)), n - 1)
    s = np.arange(n) * (pieces / (n - 1))
    first = np.clip(np.floor(s).astype(np.int64), 0, pieces - 1)
    u = s - first
    v = 1.0 - u
    values = np.stack([v**3, 3 * u**3 - 6 * u**2 + 4, 3 * v**3 - 6 * v**2 + 4, u**3], axis=1) / 6.0
    return Basis(pieces + 3, first, values)
