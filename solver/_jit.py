"""The one place that says how kernels are compiled."""

from collections.abc import Callable
from typing import TypeVar, cast

import numba

Kernel = TypeVar("Kernel", bound=Callable[..., object])


def kernel(function: Kernel) -> Kernel:
    """Compile `function` with Numba: cached on disk, free of the GIL, IEEE semantics (no fast-math).

    `error_model="numpy"` makes a division by zero give inf or nan, as in NumPy, instead of raising from a hot loop.
    """
    return cast(Kernel, numba.njit(cache=True, nogil=True, error_model="numpy")(function))
