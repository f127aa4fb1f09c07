"""Options of methods: frozen dataclasses that check themselves, field by field, when they are made."""

import math
from dataclasses import dataclass, field, fields
from enum import StrEnum
from numbers import Integral, Real
from typing import Any

from fullpose.errors import MethodError

# What counts as a number of a field's kind; NumPy's scalars do.
_NUMBERS: dict[type, type] = {int: Integral, float: Real}


@dataclass(frozen=True)
class Range:
    """The numbers in [least, most], or in (least, most] where it is `open`."""

    least: float
    most: float = math.inf
    open: bool = False

    def __contains__(self, value: float) -> bool:
        above = self.least < value if self.open else self.least <= value
        return above and value <= self.most and math.isfinite(value)

    def __str__(self) -> str:
        if self.most == math.inf:
            return f"a number above {self.least:g}" if self.open else f"a number, {self.least:g} or more"
        return f"a number in {'(' if self.open else '['}{self.least:g}, {self.most:g}]"


def ranged(default: Any, least: float, most: float = math.inf, *, open: bool = False) -> Any:  # noqa: A002
    """A field of `Options` with a number in a `Range`; a whole number where the default is one."""
    return field(default=default, metadata={"range": Range(least, most, open)})


@dataclass(frozen=True)
class Options:
    """Base of every method's options. Raises `MethodError` where a value is of another type or outside its range.

    Each subclass is a frozen dataclass whose fields all have defaults, made by `ranged` where they are numbers; a field
    with a `StrEnum` as its default takes that vocabulary's words.
    """

    def __post_init__(self) -> None:
        for each in fields(self):
            value = getattr(self, each.name)
            kind = type(each.default)
            if kind in _NUMBERS and (isinstance(value, bool) or not isinstance(value, _NUMBERS[kind])):
                raise MethodError(f"option {each.name} = {value!r}: expected {kind.__name__}")
            if kind is bool and not isinstance(value, bool):
                raise MethodError(f"option {each.name} = {value!r}: expected bool")
            if isinstance(each.default, StrEnum):
                vocabulary = type(each.default)
                if value not in list(vocabulary):
                    raise MethodError(f"option {each.name} = {value!r}: expected one of {', '.join(vocabulary)}")
                object.__setattr__(self, each.name, vocabulary(value))
            allowed = each.metadata.get("range")
            if allowed is not None and value not in allowed:
                raise MethodError(f"option {each.name} = {value!r}: expected {allowed}")
