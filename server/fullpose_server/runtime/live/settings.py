"""How a live source is flown: what `load` says of it."""

import hashlib
from dataclasses import dataclass, field
from typing import Any

import msgspec


@dataclass(frozen=True)
class LiveSettings:
    """How a live source is flown: the step method and its options."""

    method: str = "exact"
    options: dict[str, Any] = field(default_factory=dict)
    first_sample_s: float = 5.0  # to wait for the source to begin

    @property
    def hash(self) -> str:
        """sha-256 of the settings: what `arm` is held to."""
        content = [self.method, sorted(self.options.items()), self.first_sample_s]
        return hashlib.sha256(msgspec.json.encode(content)).hexdigest()


class LiveError(Exception):
    """Live settings that cannot be flown: which, and why."""
