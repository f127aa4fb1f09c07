"""Units as files write them, in a row of their own, in brackets or at the end of a name."""

import re

from fullpose_server.formats.column_map import AngleUnit, TimeUnit

_TIMES = {
    TimeUnit.S: ("s", "sec", "secs", "second", "seconds"),
    TimeUnit.MS: ("ms", "msec", "millis", "millisecond", "milliseconds"),
    TimeUnit.TENTH_MS: ("0.1ms", "0.1 ms", "100us", "100 us"),
    TimeUnit.US: ("us", "usec", "µs", "μs", "micros", "microsecond", "microseconds"),
    TimeUnit.NS: ("ns", "nsec", "nanos", "nanosecond", "nanoseconds"),
    TimeUnit.MIN: ("min", "minute", "minutes"),
    TimeUnit.H: ("h", "hour", "hours"),
}
_ANGLES = {
    AngleUnit.DEG: ("deg", "degs", "degree", "degrees", "°", "º"),
    AngleUnit.RAD: ("rad", "rads", "radian", "radians"),
    AngleUnit.CENTIDEG: (
        "cdeg",
        "centideg",
        "centidegree",
        "centidegrees",
        "deg*100",
        "degx100",
        "0.01deg",
        "0.01 deg",
    ),
}
_TIME_OF = {spelling: unit for unit, spellings in _TIMES.items() for spelling in spellings}
_ANGLE_OF = {spelling: unit for unit, spellings in _ANGLES.items() for spelling in spellings}
# What no angle, or no stamp, of ours is counted in: taken for degrees or seconds it would be wrong in silence.
_OTHER_ANGLE = re.compile(
    r"deg|rad|°|^(?:mils?|gons?|revs?|turns?|revolutions?|arc ?min|arc ?sec|rpm|dps|hz|m|m/s|ft|v)$"
)
_OTHER_TIME = re.compile(
    r"\d ?(?:s|ms|us|µs|ns)$|^(?:d|days?|weeks?|ticks?|samples?|frames?|counts?|cycles?|hz|jd|mjd)$"
)
NO_UNIT = ("", "-", "1", "n/a", "none", "[-]", "(-)")  # what a row of units has for a column without one


def bare(text: str) -> str:
    """A unit as it is compared: small letters, without brackets around it."""
    return text.strip().strip("[](){}<>").strip().casefold()


def time_unit(text: str | None) -> TimeUnit | None:
    """The unit of time of that name, alone or before other words ("s since start"); None where it is none."""
    return None if text is None else _TIME_OF.get(bare(text)) or _TIME_OF.get(_first(text))


def angle_unit(text: str | None) -> AngleUnit | None:
    """The unit of angle of that name, alone or before other words ("rad, body"); None where it is none."""
    return None if text is None else _ANGLE_OF.get(bare(text)) or _ANGLE_OF.get(_first(text))


def is_other(text: str | None, *, of_time: bool) -> bool:
    """Whether it is a unit, and none that a stamp, or an angle, is read in: mrad, deg/s, ticks."""
    if text is None or (time_unit(text) if of_time else angle_unit(text)) is not None:
        return False
    return (_OTHER_TIME if of_time else _OTHER_ANGLE).search(bare(text)) is not None


def _first(text: str) -> str:
    return re.split(r"[,;\s]", bare(text), maxsplit=1)[0]


def is_unit(text: str) -> bool:
    """Whether a cell is a unit: of time, of angle, or a sign that there is none."""
    return bare(text) in _TIME_OF or bare(text) in _ANGLE_OF or text.strip().casefold() in NO_UNIT
