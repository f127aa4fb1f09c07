"""Which samples of a live source are used, and why the others are not."""

import math
from dataclasses import dataclass
from typing import Any

from fullpose_server.runtime.live.packets import LiveSample, LiveStatus

USED = LiveStatus(0)
_SOURCE_SILENT_S = 0.5  # then another may be followed in its place


@dataclass(frozen=True)
class Outcome:
    """What becomes of a sample: `unused`, why it is not, else `USED`; `rate`, why it is implausible [rad/s], or nan."""

    unused: LiveStatus = USED
    rate: float = math.nan


class Admission:
    """Weighs the samples of one rig's live source, and counts those that are not used."""

    def __init__(self, plausible: float) -> None:
        """plausible: the greatest body rate of a sample that is used [rad/s]."""
        self.plausible = plausible
        self.implausible_rate = 0.0  # [rad/s] of the newest sample beyond it
        self.begin()

    def begin(self) -> None:
        """Whoever is heard first is followed."""
        self.unproven = 0  # samples that are not of the loaded source
        self.strangers = 0  # samples of another source than the one that is followed
        self.implausible = 0
        self._source: tuple[int, Any] | None = None  # socket and sender that is followed
        self._source_at = 0.0  # [s] when it was heard

    def unproved(self) -> Outcome:
        """Of a sample that does not prove to be of the loaded source."""
        self.unproven += 1
        return Outcome(LiveStatus.UNPROVEN)

    def weigh(self, source: tuple[int, Any], rate: float, now: float) -> Outcome:
        """Of a sample of `source`, which is a socket and a sender, that turns the body at `rate` [rad/s]."""
        if not self._is_followed(source, now):
            return Outcome(LiveStatus.DROPPED)
        if not rate <= self.plausible:
            self.implausible += 1
            self.implausible_rate = rate
            return Outcome(LiveStatus.IMPLAUSIBLE, rate)
        return Outcome()

    def _is_followed(self, source: tuple[int, Any], now: float) -> bool:
        """One source a rig: the first to be heard, until it has been silent for a while."""
        if source != self._source:
            if self._source is not None and now - self._source_at < _SOURCE_SILENT_S:
                self.strangers += 1
                return False
            self._source = source
        self._source_at = now
        return True


@dataclass(frozen=True)
class Taken:
    """A sample that came at `arrived` [s] by `via` from `sender`, and what became of it."""

    sample: LiveSample
    outcome: Outcome
    arrived: float
    via: Any
    sender: Any
