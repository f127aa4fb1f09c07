"""The one interface of the step methods.

A step method sees one sample at a time. `StepMethod.stepper` builds the state of one flight in progress; its `block`
advances over m samples (m = 1 for live use, more for a file), so files, streams and timings share one code path.
"""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Protocol, runtime_checkable

from fullpose._typing import Array, Codes, Counts
from fullpose.rig import Rig


@dataclass(frozen=True)
class Block:
    """Results of m samples: angles (m, 4) [rad], limited (m,) codes, iterations (m,)."""

    angles: Array
    limited: Codes
    iterations: Counts


class Stepper(Protocol):
    """A flight in progress: keeps pose, rate and multipliers from block to block."""

    def block(self, time: Array, attitude: Array) -> Block:
        """Advance over samples: time (m,) [s] increasing from call to call, attitude (m, 3, 3) body from reference."""
        ...


@runtime_checkable
class LiveStepper(Stepper, Protocol):
    """What the methods that claim the limits have too, to take over a rig that stands."""

    def begin_at_rest(self, dt: float) -> None:
        """Stand at the start pose at time 0, `dt` [s] after standing there; without it the first rate is free."""
        ...


@dataclass(frozen=True)
class StepMethod:
    """A method of the literature, as the registry knows it."""

    name: str
    source: str  # paper, section, equation
    claims_limits: bool
    options: type[Any]  # a frozen dataclass with defaults
    # (rig, options, near which pose (4,) [rad] to start, None for home, first attitude (3, 3)) -> Stepper
    stepper: Callable[[Rig, Any, Array | None, Array], Stepper]
