"""A record that is played without being in memory: an hour at 1 kHz would take a gigabyte and a half."""

from fullpose_server.runtime.contract.telemetry import Samples
from fullpose_server.runtime.recording.curves import Curves


class LongReplay:
    """As `mcap_reader.Replay`, of a record whose curves are made: of its chunks those are read that are played."""

    def __init__(self, curves: Curves) -> None:
        self._rows = curves.rows
        self._begun_ns = curves.begun_ns
        self._head = 0
        self.duration_s = curves.about.duration_s

    def seek(self, time_s: float) -> None:
        """To `time_s` after the first row."""
        self._head = self._rows.until(self._begun_ns + int(time_s * 1e9)) if len(self._rows) else 0

    def since(self, sequence: int, limit: int) -> tuple[Samples, int]:
        """Rows after `sequence` up to where the replay stands, at most `limit`; nothing is ever lost."""
        first = self._rows.numbered(sequence)
        return self._rows.between(first, min(self._head, first + limit)), 0

    def latest(self) -> Samples | None:
        """The row where the replay stands (1,)."""
        return self._rows.between(self._head - 1, self._head) if self._head else None
