"""Release and acquire fences as machine code, for processors that keep neither stores nor loads in order (ARM).

`memory_order` says when they are needed, and imports them only then: Numba is much for a process that only copies.
"""

from typing import Any

import numba
from numba.core import types
from numba.extending import intrinsic


def _fence(ordering: str) -> Any:
    """An intrinsic that is LLVM's `fence` of that ordering: an instruction on ARM, none on x86."""

    @intrinsic
    def fence(_typing: Any) -> Any:
        def emit(context: Any, builder: Any, _signature: Any, _arguments: Any) -> Any:
            builder.fence(ordering)
            return context.get_dummy_value()  # None

        return types.none(), emit

    return fence


_release, _acquire = _fence("release"), _fence("acquire")


# Compiled at the import, by the signature, and not at the first call: that may be in a rig's loop. No kernel of
# `fullpose._jit`: those let go of the interpreter's lock, which costs more than a fence.
@numba.njit("void()", cache=True)
def release() -> None:
    """What was written before is seen before what is written from here on."""
    _release()


@numba.njit("void()", cache=True)
def acquire() -> None:
    """What is read from here on is no older than what was read before."""
    _acquire()
