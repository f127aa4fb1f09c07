"""Thinning long arrays for plots without losing their peaks."""

from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray


def thin(n: int, points: int, *columns: NDArray[Any]) -> NDArray[np.int64]:
    """Rows to keep of n: evenly spread, first and last, and where any column is largest or smallest in its part.

    columns: (n,) or (n, k), nan allowed. Returns at most about `points` rows where that leaves room for the extremes
    (two a column and part), in order.
    """
    if n <= points:
        return np.arange(n)
    flat = np.column_stack([np.asarray(column, float).reshape(n, -1) for column in columns]) if columns else None
    width = 0 if flat is None else flat.shape[1]
    parts = max(1, points // (1 + 2 * width))
    edges = np.linspace(0, n, parts + 1).astype(np.int64)
    keep = [edges[:-1], np.array([n - 1])]
    if flat is not None:
        for begin, end in pairwise(edges.tolist()):
            part = flat[begin:end]
            seen = np.isfinite(part)
            keep.append(begin + np.argmax(np.where(seen, part, -np.inf), axis=0))
            keep.append(begin + np.argmin(np.where(seen, part, np.inf), axis=0))
    return np.unique(np.concatenate(keep))
