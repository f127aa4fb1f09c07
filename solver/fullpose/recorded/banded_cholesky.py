"""Symmetric positive definite banded systems, by Cholesky (Golub and Van Loan, "Matrix Computations", section 4.3.5).

LAPACK's own takes threads for blocks that are a few numbers wide: on a machine that is busy with something else that
made it a hundred times slower.
"""

import math

from fullpose._jit import kernel
from fullpose._typing import Array


@kernel
def solve_banded(bands: Array, right: Array) -> bool:
    """right (n, d) <- A^-1 right, in place; false where A is not positive definite to the last digit.

    bands (w, n): the upper bands of A, the diagonal last: bands[w - 1 - (j - i), j] = A[i, j]. They are left as the
    factor U of A = U^T U.
    """
    width, n = bands.shape
    last = width - 1
    for j in range(n):
        for i in range(max(0, j - last), j):
            total = bands[last - (j - i), j]
            for k in range(max(0, j - last), i):
                total -= bands[last - (i - k), i] * bands[last - (j - k), j]
            bands[last - (j - i), j] = total / bands[last, i]
        pivot = bands[last, j]
        for k in range(max(0, j - last), j):
            pivot -= bands[last - (j - k), j] ** 2
        if not pivot > 0.0:
            return False
        bands[last, j] = math.sqrt(pivot)
    for c in range(right.shape[1]):
        for j in range(n):
            total = right[j, c]
            for k in range(max(0, j - last), j):
                total -= bands[last - (j - k), j] * right[k, c]
            right[j, c] = total / bands[last, j]
        for j in range(n - 1, -1, -1):
            right[j, c] /= bands[last, j]
            for k in range(max(0, j - last), j):
                right[k, c] -= bands[last - (j - k), j] * right[j, c]
    return True
