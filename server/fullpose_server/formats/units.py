"""Units as files write them, in a row of their own, in brackets or at the end of a name."""

from fullpose_server.formats.column_map import AngleUnit, TimeUnit

_TIMES = {
    TimeUnit.S: ("s", "sec", "secs", "second", "seconds"),
    TimeUnit.MS: ("ms", "msec", "millis", "millisecond", "milliseconds"),
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
NO_UNIT = ("", "-", "1", "n/a", "none", "[-]", "(-)")  # what a row of units has for a column without one


def bare(text: str) -> str:
    """A unit as it is compared: small letters, without brackets around it."""
    return text.strip().strip("[](){}<>").strip().casefold()


def time_unit(text: str | None) -> TimeUnit | None:
    """The unit of time of that name; None where it is none."""
    return None if text is None else _TIME_OF.get(bare(text))


def angle_unit(text: str | None) -> AngleUnit | None:
    """The unit of angle of that name; None where it is none."""
    return None if text is None else _ANGLE_OF.get(bare(text))


def is_unit(text: str) -> bool:
    """Whether a cell is a unit: of time, of angle, or a sign that there is none."""
    return bare(text) in _TIME_OF or bare(text) in _ANGLE_OF or text.strip().casefold() in NO_UNIT
