"""The one place that says how kernels are compiled."""

import contextlib
import warnings
from collections.abc import Callable
from typing import Any, TypeVar, cast

import numba
from numba.core.caching import FunctionCache

Kernel = TypeVar("Kernel", bound=Callable[..., object])
Scalar = float | bool | None  # int is a float to the type checker
Inner = TypeVar("Inner", bound=Callable[..., Scalar | tuple[Scalar, ...]])

NOWHERE = (
    "neither the package's folder nor the user's cache can be written: every process compiles its kernels anew, which "
    "takes up to a minute; set NUMBA_CACHE_DIR to a folder that can be"
)
BORROW: dict[str, Any] = {"_nrt": False}  # no count of an array's owners; not in Numba's type stubs


_FunctionCache: Any = FunctionCache  # Numba's functions have no types


class Cache(_FunctionCache):  # type: ignore[misc]
    """Numba's cache on disk; what cannot be read or kept there is compiled anew, and does not end the program.

    Numba reads the index before it sees that the index is of an older source: one that names a record which has been
    renamed since, or that was cut short, raises from the first call of the kernel.
    """

    def load_overload(self, sig: Any, target_context: Any) -> Any:
        """The compiled kernel of a signature, None where there is none."""
        try:
            return super().load_overload(sig, target_context)
        except Exception:  # noqa: BLE001 - unpickling raises what it likes
            self.flush()
            return None

    def save_overload(self, sig: Any, data: Any) -> None:
        """Keep a compiled kernel; where there is no room it is compiled again next time."""
        with contextlib.suppress(OSError):
            super().save_overload(sig, data)


def _cached(function: Callable[..., object], **options: Any) -> Any:
    compiled = numba.njit(nogil=True, error_model="numpy", **options)(function)
    try:
        compiled._cache = Cache(function)  # noqa: SLF001 - as `cache=True` does; Numba has no other way to give it one
    except RuntimeError:
        warnings.warn(NOWHERE, RuntimeWarning, stacklevel=3)
    return compiled


def kernel(function: Kernel) -> Kernel:
    """Compile `function` with Numba: cached on disk, free of the GIL, IEEE semantics (no fast-math).

    `error_model="numpy"` makes a division by zero give inf or nan, as in NumPy, instead of raising from a hot loop.
    """
    return cast(Kernel, _cached(function))


def inner(function: Inner) -> Inner:
    """A kernel that works only on arrays that its caller holds: it makes none and returns none.

    So nobody need count their owners, which Numba otherwise does, atomically, at every view and every call: that was
    half of a step. What it must not do, tests/fullpose/test_jit.py looks for: Numba does not refuse all of it.
    """
    return cast(Inner, _cached(function, **BORROW))


def inlined(function: Inner) -> Inner:
    """An `inner` kernel that becomes part of its caller: for the small ones, whose call costs more than they do."""
    return cast(Inner, _cached(function, forceinline=True, **BORROW))
