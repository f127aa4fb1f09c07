"""The one place that says how kernels are compiled."""

from collections.abc import Callable
from typing import Any, TypeVar, cast

import numba

Kernel = TypeVar("Kernel", bound=Callable[..., object])
Scalar = float | bool | None  # int is a float to the type checker
Inner = TypeVar("Inner", bound=Callable[..., Scalar | tuple[Scalar, ...]])

BORROW: dict[str, Any] = {"_nrt": False}  # no count of an array's owners; not in Numba's type stubs


def kernel(function: Kernel) -> Kernel:
    """Compile `function` with Numba: cached on disk, free of the GIL, IEEE semantics (no fast-math).

    `error_model="numpy"` makes a division by zero give inf or nan, as in NumPy, instead of raising from a hot loop.
    """
    return cast(Kernel, numba.njit(cache=True, nogil=True, error_model="numpy")(function))


def inner(function: Inner) -> Inner:
    """A kernel that works only on arrays that its caller holds: it makes none and returns none.

    So nobody need count their owners, which Numba otherwise does, atomically, at every view and every call: that was
    half of a step. What it must not do, tests/fullpose/test_jit.py looks for: Numba does not refuse all of it.
    """
    return cast(Inner, numba.njit(cache=True, nogil=True, error_model="numpy", **BORROW)(function))


def inlined(function: Inner) -> Inner:
    """An `inner` kernel that becomes part of its caller: for the small ones, whose call costs more than they do."""
    return cast(Inner, numba.njit(cache=True, nogil=True, error_model="numpy", forceinline=True, **BORROW)(function))
