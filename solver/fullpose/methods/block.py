"""The one block loop of the step methods, and what runs it: a stepper with a flight in progress.

A method is a kernel, `propose`, that fills the flight's next sample; the loop reads the clock before it and keeps the
sample after it. What a method has beside the flight, its options and what it keeps for itself, is a record of its own.
"""

from collections.abc import Callable, Sequence
from dataclasses import fields
from enum import StrEnum
from types import FunctionType
from typing import Any

import numpy as np

from fullpose._jit import kernel
from fullpose._typing import Array, Codes, Counts
from fullpose.methods.base import Block
from fullpose.methods.state import FLIGHT, FRESH, Flight, advance
from fullpose.options import Options

# (flights (1,), the method's parameters, time (m,) [s], attitude (m, 3, 3), angles (m, 4) [rad], codes and iterations)
BlockKernel = Callable[[Any, Any, Array, Array, Array, Codes, Counts], None]
Step = Callable[[Flight, Any, Array], tuple[int, int]]

_FORMATS = {bool: "?", int: "i8", float: "f8"}


def propose(flight: Flight, parameters: Any, C: Array) -> tuple[int, int]:
    """next <- the sample for C (3, 3), `ahead` [s] from the last; returns (iterations, `limited_code`).

    `block_kernel` puts each method's own here.
    """
    raise NotImplementedError


def _block(
    flights: Any, parameters: Any, time: Array, attitude: Array, angles: Array, limited: Codes, iterations: Counts
) -> None:
    """Advance `flights[0]` over m samples; see `BlockKernel`."""
    flight = flights[0]
    for k in range(time.shape[0]):
        if flight.phase == FRESH:
            count, code = 0, int(flight.code)
            for i in range(4):
                flight.next[i] = flight.pose[i]
        else:
            flight.ahead = time[k] - flight.clock
            count, code = propose(flight, parameters, attitude[k])
        for i in range(4):
            angles[k, i] = flight.next[i]
        limited[k] = code
        iterations[k] = count
        advance(flight, time[k], code, attitude[k])


def block_kernel(name: str, step: Step) -> BlockKernel:
    """The block loop around a method's step, a kernel of its own.

    The loop's code with the step for its `propose`: a kernel that took the step as an argument, or from a closure,
    could not be cached on disk by Numba.
    """
    block = FunctionType(_block.__code__, {**_block.__globals__, "propose": step}, name)
    block.__qualname__ = name
    block.__module__ = __name__
    compiled: BlockKernel = kernel(block)
    return compiled


def record_of(options: Options, own: Sequence[tuple[str, str]] = ()) -> Any:
    """(1,) the options as a kernel reads them, by their names, a vocabulary's word by its place in it.

    own: (name, NumPy format) of what the method keeps for itself beside them, all zero.
    """
    values = {each.name: getattr(options, each.name) for each in fields(options)}
    for name, value in values.items():
        if isinstance(value, StrEnum):
            values[name] = list(type(value)).index(value)
    layout = [(name, _FORMATS[type(value)]) for name, value in values.items()]
    record = np.zeros(1, np.dtype((np.record, np.dtype([*layout, *own], align=True))))
    for name, value in values.items():
        record[name] = value
    return record


class BlockStepper:
    """One flight in progress."""

    def __init__(self, block: BlockKernel, parameters: Any, flight: Flight) -> None:
        self._block = block
        self._parameters = parameters
        self._flights = np.zeros(1, FLIGHT)
        self._flights[0] = flight
        self._flight: Flight = self._flights[0]

    def block(self, time: Array, attitude: Array) -> Block:
        """Advance over samples: time (m,) [s], attitude (m, 3, 3)."""
        m = len(time)
        out = Block(np.empty((m, 4)), np.empty(m, np.int16), np.empty(m, np.int32))
        self._block(
            self._flights, self._parameters, time, np.ascontiguousarray(attitude),
            out.angles, out.limited, out.iterations,
        )  # fmt: skip
        return out
