"""The stop gate as the server's health sees it."""

from dataclasses import dataclass


@dataclass
class FrontStatus:
    """Kept by the gate's keeper. Without a gate (a server run by other means) nothing is told."""

    down_since: float | None = None  # [s] since the epoch; None: it runs

    def faults(self) -> list[str]:
        """What is wrong with it; nothing while all is well."""
        return [] if self.down_since is None else ["the stop gate has ended and is being started anew"]
