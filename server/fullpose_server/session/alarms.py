"""Alarms: severity, latched first-out, acknowledge, history. Pure; told the time [s since the Unix epoch].

The first alarm of a chain is marked `first`: after one cause many alarms follow, and the operator needs the cause. A
chain ends when its faults have left, or when the link is made anew.
Warnings leave when acknowledged. Faults stay through a latch, until the session is reset; outside one nothing is to be
reset, and they leave when acknowledged too (`link_lost`, which leads to disconnected), so that the next is a `first`.
A warning can be shelved, for a time that ends (IEC 62682): it is in the history, and does not stand. What brakes a rig
cannot be shelved.
"""

from dataclasses import dataclass, replace
from enum import StrEnum

HISTORY = 256
MAX_SHELF_S = 12.0 * 3600.0  # a shift: what is shelved for longer is forgotten
MAX_SHELVES = 64


class Severity(StrEnum):
    """How bad: a warning leaves the motion alone, a fault brakes, an emergency brakes and disables."""

    WARNING = "warning"
    FAULT = "fault"
    EMERGENCY = "emergency"


@dataclass(frozen=True)
class Alarm:
    """One thing that went wrong. `value` and `limit` are in the unit that `unit` names."""

    number: int
    code: str
    severity: Severity
    message: str
    time_s: float  # Unix time of the first occurrence
    frame: str | None = None
    value: float | None = None
    limit: float | None = None
    unit: str | None = None
    first: bool = False
    acknowledged_by: str | None = None
    acknowledged_s: float | None = None  # Unix time of that
    count: int = 1
    last_time_s: float | None = None  # of the newest occurrence, where there was more than one
    shelved: bool = False  # it was raised on a shelf: in the history alone


@dataclass(frozen=True)
class Shelf:
    """Warnings of this code do not stand until the time has come [s, Unix]; `frame` None: of every frame."""

    code: str
    frame: str | None
    since_s: float
    until_s: float
    by: str
    reason: str = ""

    def __post_init__(self) -> None:
        lasts = self.until_s - self.since_s
        if not 0.0 < lasts <= MAX_SHELF_S:
            raise ValueError(f"a shelf of {lasts:g} s: expected above 0, at most {MAX_SHELF_S:g} s")

    def lasts(self, now_s: float) -> bool:
        """Whether its time is not over: before its beginning, the clock was set back, and its end is not known."""
        return self.since_s <= now_s < self.until_s

    def holds(self, code: str, frame: str | None) -> bool:
        """Whether a warning is shelved by it."""
        return self.code == code and self.frame in (None, frame)


@dataclass(frozen=True)
class AlarmBook:
    """Standing alarms and the history. Immutable: every method returns the next book."""

    standing: tuple[Alarm, ...] = ()
    history: tuple[Alarm, ...] = ()
    last_number: int = 0
    shelves: tuple[Shelf, ...] = ()
    chained: bool = False  # the chain of faults that is going on has its first

    def raised(
        self,
        code: str,
        severity: Severity,
        message: str,
        time_s: float,
        frame: str | None = None,
        value: float | None = None,
        limit: float | None = None,
        unit: str | None = None,
    ) -> "AlarmBook":
        """The book with this alarm standing. The same again (code, frame, severity) only counts up, with its time.

        A warning that is shelved is counted in the history, and does not stand: those whose time is over have `ended`.
        """
        if severity is Severity.WARNING and any(shelf.holds(code, frame) for shelf in self.shelves):
            return self._shelved(Alarm(0, code, severity, message, time_s, frame, value, limit, unit, shelved=True))
        latching = severity is not Severity.WARNING
        first = latching and not self.chained
        for index, old in enumerate(self.standing):
            same = (old.code, old.frame, old.severity) == (code, frame, severity)
            if same and old.acknowledged_by is None:
                again = replace(old, count=old.count + 1, last_time_s=time_s, first=old.first or first)
                return replace(
                    self,
                    chained=self.chained or latching,
                    standing=(*self.standing[:index], again, *self.standing[index + 1 :]),
                    history=tuple(again if a.number == again.number else a for a in self.history),
                )
        number = self.last_number + 1
        alarm = Alarm(number, code, severity, message, time_s, frame, value, limit, unit, first)
        standing, history = (*self.standing, alarm), (*self.history, alarm)[-HISTORY:]
        chained = self.chained or latching
        return replace(self, standing=standing, history=history, last_number=number, chained=chained)

    def _shelved(self, alarm: Alarm) -> "AlarmBook":
        key = (alarm.code, alarm.frame)
        newest = next((a for a in reversed(self.history) if a.shelved and (a.code, a.frame) == key), None)
        if newest is not None:
            again = replace(newest, count=newest.count + 1, last_time_s=alarm.time_s)
            return replace(self, history=tuple(again if a is newest else a for a in self.history))
        number = self.last_number + 1
        history = (*self.history, replace(alarm, number=number))[-HISTORY:]
        return replace(self, history=history, last_number=number)

    def shelve(self, shelf: Shelf) -> "AlarmBook":
        """The book with this shelf in place of an earlier one for the same; standing warnings of it leave.

        Of too many shelves the one that ends first goes.
        """
        others = self.unshelved(shelf.code, shelf.frame).ended(shelf.since_s).shelves
        shelves = tuple(sorted((*others, shelf), key=lambda s: s.until_s)[-MAX_SHELVES:])

        def stays(alarm: Alarm) -> bool:
            return alarm.severity is not Severity.WARNING or not shelf.holds(alarm.code, alarm.frame)

        return replace(self, standing=tuple(a for a in self.standing if stays(a)), shelves=shelves)

    def unshelved(self, code: str, frame: str | None) -> "AlarmBook":
        """The book without the shelf for this code and frame."""
        return replace(self, shelves=tuple(s for s in self.shelves if (s.code, s.frame) != (code, frame)))

    def ended(self, now_s: float) -> "AlarmBook":
        """The book without the shelves whose time is over."""
        kept = tuple(s for s in self.shelves if s.lasts(now_s))
        return self if len(kept) == len(self.shelves) else replace(self, shelves=kept)

    def acknowledged(self, who: str, numbers: frozenset[int] | None = None, time_s: float | None = None) -> "AlarmBook":
        """The book after `who` has seen these alarms (None: all) at `time_s` [s, Unix].

        Warnings leave, faults stay until `cleared`.
        """

        def seen(alarm: Alarm) -> Alarm:
            named = numbers is None or alarm.number in numbers
            if not named or alarm.acknowledged_by is not None:
                return alarm
            return replace(alarm, acknowledged_by=who, acknowledged_s=time_s)

        marked = {alarm.number: seen(alarm) for alarm in self.standing}
        standing = tuple(a for a in marked.values() if a.severity is not Severity.WARNING or a.acknowledged_by is None)
        history = tuple(marked.get(alarm.number, alarm) for alarm in self.history)
        return replace(self, standing=standing, history=history)

    def cleared(self) -> "AlarmBook":
        """The book after a reset, or where there is nothing to reset: what was acknowledged no longer stands."""
        standing = tuple(a for a in self.standing if a.acknowledged_by is None)
        chained = self.chained and any(a.severity is not Severity.WARNING for a in standing)
        return replace(self, standing=standing, chained=chained)

    def first_awaited(self) -> "AlarmBook":
        """The book for which the next fault is a first, whatever stands of before."""
        return replace(self, chained=False)

    @property
    def unacknowledged(self) -> tuple[Alarm, ...]:
        """Standing faults and emergencies that nobody has acknowledged."""
        return tuple(a for a in self.standing if a.severity is not Severity.WARNING and a.acknowledged_by is None)
