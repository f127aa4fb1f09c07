"""Alarms: severity, latched first-out, acknowledge, history. Pure; told the time [s since the Unix epoch].

The first alarm of a chain is marked `first`: after one cause many alarms follow, and the operator needs the cause.
Warnings leave when acknowledged. Faults stay through a latch, until the session is reset; outside one nothing is to be
reset, and they leave when acknowledged too (`link_lost`, which leads to disconnected), so that the next is a `first`.
"""

from dataclasses import dataclass, replace
from enum import StrEnum

HISTORY = 256


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
    count: int = 1
    last_time_s: float | None = None  # of the newest occurrence, where there was more than one


@dataclass(frozen=True)
class AlarmBook:
    """Standing alarms and the history. Immutable: every method returns the next book."""

    standing: tuple[Alarm, ...] = ()
    history: tuple[Alarm, ...] = ()
    last_number: int = 0

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
        """The book with this alarm standing. The same again (code, frame, severity) only counts up, with its time."""
        for index, old in enumerate(self.standing):
            same = (old.code, old.frame, old.severity) == (code, frame, severity)
            if same and old.acknowledged_by is None:
                again = replace(old, count=old.count + 1, last_time_s=time_s)
                return replace(
                    self,
                    standing=(*self.standing[:index], again, *self.standing[index + 1 :]),
                    history=tuple(again if a.number == again.number else a for a in self.history),
                )
        latching = severity is not Severity.WARNING
        first = latching and not any(a.severity is not Severity.WARNING for a in self.standing)
        number = self.last_number + 1
        alarm = Alarm(number, code, severity, message, time_s, frame, value, limit, unit, first)
        return AlarmBook((*self.standing, alarm), (*self.history, alarm)[-HISTORY:], number)

    def acknowledged(self, who: str, numbers: frozenset[int] | None = None) -> "AlarmBook":
        """The book after `who` has seen these alarms (None: all). Warnings leave, faults stay until `cleared`."""

        def seen(alarm: Alarm) -> Alarm:
            named = numbers is None or alarm.number in numbers
            return replace(alarm, acknowledged_by=who) if named and alarm.acknowledged_by is None else alarm

        marked = {alarm.number: seen(alarm) for alarm in self.standing}
        standing = tuple(a for a in marked.values() if a.severity is not Severity.WARNING or a.acknowledged_by is None)
        history = tuple(marked.get(alarm.number, alarm) for alarm in self.history)
        return replace(self, standing=standing, history=history)

    def cleared(self) -> "AlarmBook":
        """The book after a reset, or where there is nothing to reset: what was acknowledged no longer stands."""
        return replace(self, standing=tuple(a for a in self.standing if a.acknowledged_by is None))

    @property
    def unacknowledged(self) -> tuple[Alarm, ...]:
        """Standing faults and emergencies that nobody has acknowledged."""
        return tuple(a for a in self.standing if a.severity is not Severity.WARNING and a.acknowledged_by is None)
