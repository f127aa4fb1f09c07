"""A method as it is asked for in a comparison: its name, its options, and a label that tells it from the others."""

from collections.abc import Mapping
from dataclasses import dataclass, field

OptionValue = bool | int | float | str


@dataclass(frozen=True)
class Variant:
    """`options` by name, those not given at their defaults; `fullpose.registry.variant` checks them."""

    method: str
    label: str
    options: Mapping[str, OptionValue] = field(default_factory=dict)
