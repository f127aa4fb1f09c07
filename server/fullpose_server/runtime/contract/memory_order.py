"""The order in which other processes see what one writes to memory that they share.

Between what it wrote and the number that tells of it a writer says `release`; between reading that number and what it
tells of a reader says `acquire`. Then who sees the number sees what came before it (C11, 7.17.4; Boehm 2012, "Can
seqlocks get along with programming language memory models?"). x86 keeps stores in order, and loads, by itself; every
other processor is given the fences. Between two calls of the interpreter no compiler changes the order.
"""

import platform
from collections.abc import Callable

TOTAL_STORE_ORDER = frozenset(
    {"x86_64", "amd64", "i686", "i386"}
)  # what `platform.machine()` says of them, in lower case

Fence = Callable[[], None]


def in_order() -> None:
    """Nothing: this processor keeps the order."""


def fences_of(machine: str) -> tuple[Fence, Fence]:
    """(release, acquire) for a processor by the name that the system gives it."""
    if machine.lower() in TOTAL_STORE_ORDER:
        return in_order, in_order
    from fullpose_server.runtime.contract import fences  # with it comes Numba, heavier than all of a recorder

    return fences.release, fences.acquire


release, acquire = fences_of(platform.machine())
