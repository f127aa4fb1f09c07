"""Settings of a live source (see `follow` for the source itself)."""

import hashlib
from dataclasses import dataclass, field
from typing import Any

import msgspec


@dataclass(frozen=True)
class LiveSettings:
    """How a live source is flown: the step method and its options."""

    method: str = "exact"
    options: dict[str, Any] = field(default_factory=dict)

    @property
    def hash(self) -> str:
        """sha-256 of the settings: what `arm` is held to."""
        return hashlib.sha256(msgspec.json.encode([self.method, sorted(self.options.items())])).hexdigest()
