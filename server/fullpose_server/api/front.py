"""The stop gate as the server's health sees it."""

from dataclasses import dataclass


@dataclass
class FrontStatus:
    """Kept by the gate's keeper. Without a gate (a server run by other means) nothing is told."""

    down_since: float | None = None  # [s] since the epoch; None: it runs
    waiting: int = 0  # connections that have asked for nothing yet
    dropped: int = 0  # of those, closed for others' sake or after their time
    refused: int = 0  # connections beyond what the server may serve at once

    def faults(self) -> list[str]:
        """What is wrong with it; nothing while all is well."""
        return [] if self.down_since is None else ["the stop gate has ended and is being started anew"]
