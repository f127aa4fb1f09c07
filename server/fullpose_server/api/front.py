"""The stop gate as the server's health sees it."""

from dataclasses import dataclass


@dataclass
class FrontStatus:
    """Kept by the gate's keeper. Without a gate (a server run by other means) nothing is told."""

    down_since: float | None = None  # [s] since the epoch; None: it runs

    def faults(self) -> list[str]:
        """What is wrong with it; nothing while all is well."""
        if self.down_since is None:
            return []
        return ["the stop gate has ended: the server stands in for it until another has begun"]
