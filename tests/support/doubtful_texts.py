"""One flight written wrong, or in ways that invite a wrong reading: each with what is right of it.

What is right: that it is the flight ("flight"), that it is read with a caution of a code, or words of a refusal. The
truth is SciPy's, of the angles before anything was done to them.
"""

from dataclasses import dataclass, field

import numpy as np
from scipy.spatial.transform import Rotation

N = 120
TIME = 0.02 * np.arange(N)
HEADING, PITCH, BANK = 40.0 + 30.0 * TIME, 2.0 + 14.0 * np.sin(3.0 * TIME), 3.0 + 25.0 * np.sin(2.0 * TIME)
ANGLES = np.column_stack([HEADING, PITCH, BANK])
TRUTH = Rotation.from_euler("ZYX", ANGLES, degrees=True)
NAMES = "time_s,heading_deg,pitch_deg,bank_deg"


@dataclass(frozen=True)
class Doubtful:
    """A file, how it is read, and what is right: "flight", a caution's code, or words of a refusal."""

    content: str | bytes
    right: str
    said: dict[str, str] = field(default_factory=dict)  # `ReadOptions`
    truth: Rotation = TRUTH
    axes: str = "ned"
    refused: bool = False
    place: str = ""  # words of the caution's message


def table(header: str, *columns: np.ndarray, separator: str = ",", digits: str = "") -> str:
    def cell(value: float) -> str:
        return format(value, digits) if digits else repr(float(value))

    rows = [separator.join(map(cell, row)) for row in zip(*columns, strict=True)]
    return "\n".join([header, *rows, ""])


def with_value(column: int, row: int, value: float) -> str:
    angles = ANGLES.copy()
    angles[row, column] = value
    return table(NAMES, TIME, *angles.T)


def _refused(content: str | bytes, words: str, **said: str) -> Doubtful:
    return Doubtful(content, words, said, refused=True)


def _warned(content: str | bytes, code: str, place: str = "", **said: str) -> Doubtful:
    return Doubtful(content, code, said, place=place)


_PLAIN = table(NAMES, TIME, *ANGLES.T)
_SHORT = table(NAMES, TIME, *ANGLES.T, digits=".3f")
_RAD = np.radians(ANGLES).T
_ZERO = np.zeros(N)
_Q = TRUTH.as_quat(scalar_first=True).T
_SPIN = {
    each: Rotation.from_euler("ZYX", np.column_stack([_ZERO, _ZERO, each * np.arange(N)]), degrees=True)
    for each in (150.0, 330.0, 360.0)
}
# ENU with x forward, y left, z up: yaw from east counterclockwise, pitch and roll about y left and x forward.
_ENU = Rotation.from_euler("ZYX", np.column_stack([90.0 - HEADING, -PITCH, BANK]), degrees=True)
_NUE = Rotation.from_euler("YZX", np.column_stack([-HEADING, PITCH, BANK]), degrees=True)


def _columns(axes: str, angles: list[str], order: str, unit: str = "deg") -> dict[str, str]:
    names = ", ".join(f'"{name}"' for name in angles)
    return {
        "columns": f'{{"axes": "{axes}", "time": {{"column": "t"}},'
        f' "euler": {{"columns": [{names}], "order": "{order}", "unit": "{unit}"}}}}'
    }


def _quaternion(axes: str, sense: str) -> dict[str, str]:
    return {
        "columns": f'{{"axes": "{axes}", "time": {{"column": "t"}},'
        f' "quaternion": {{"columns": ["a", "b", "c", "d"], "sense": "{sense}"}}}}'
    }


def _orders() -> dict[str, Doubtful]:
    found = {}
    for order in ("XYZ", "XZY", "YXZ", "YZX", "ZXY", "ZYX", "XYX", "XZX", "YXY", "YZY", "ZXZ", "ZYZ"):
        angles = TRUTH.as_euler(order, degrees=True)
        content = table("t,a,b,c", TIME, *angles.T)
        found[f"order {order}"] = Doubtful(content, "flight", _columns("ned", ["a", "b", "c"], order))
    return found


def _senses() -> dict[str, Doubtful]:
    found = {}
    for axes, truth in (("ned", TRUTH), ("enu", _ENU), ("nue", _NUE)):
        for sense, turn in (("body_to_reference", truth), ("reference_to_body", truth.inv())):
            content = table("t,b,c,d,a", TIME, *turn.as_quat().T)  # x, y, z, w
            found[f"quaternion {axes}, {sense}"] = Doubtful(
                content, "flight", _quaternion(axes, sense), truth=truth, axes=axes
            )
    return found


def _sentinels() -> dict[str, Doubtful]:
    values = (
        -9999.0,
        655.35,
        1e15,
        9999.0,
        327.67,
        6553.5,
        65535.0,
        -32768.0,
        2147483647.0,
        -2147483648.0,
        1e38,
        999.0,
    )
    found = {f"sentinel {value:g}": _warned(with_value(0, 60, value), "sentinel", "line 62") for value in values}
    return found | {
        "sentinel at the beginning": _warned(with_value(1, 0, -9999.0), "sentinel", "line 2"),
        "sentinel at the end": _warned(with_value(2, N - 1, 655.35), "sentinel", f"line {N + 1}"),
        "a column of sentinels": _warned(table(NAMES, TIME, _ZERO + 655.35, PITCH, BANK), "sentinel", "every sample"),
        "slow samples with a sentinel": _warned(
            table(NAMES, 10 * TIME, *ANGLES.T).replace(repr(float(HEADING[50])), "327.67"), "sentinel", "line 52"
        ),
    }


def _cut() -> dict[str, Doubtful]:
    lines = _SHORT.rstrip("\n").split("\n")
    *head, last = lines
    return {
        "cut in the second column": _warned("\n".join([*head, last[:9]]), "cut", f"line {N + 1}"),
        "cut after a comma": _warned("\n".join([*head, last.rpartition(",")[0] + ","]), "cut", f"line {N + 1}"),
        "cut in a number": _warned("\n".join([*head, last[:-5]]), "cut", f"line {N + 1}, column bank_deg"),
        "cut after a sign": _warned("\n".join([*head, last.rpartition(",")[0] + ",-"]), "cut", f"line {N + 1}"),
        "cut in an exponent": _warned(
            table(NAMES, TIME, *ANGLES.T, digits=".6e").rstrip("\n")[:-1], "cut", f"line {N + 1}"
        ),
        "cut, of UTF-16": _warned("\n".join([*head, last[:9]]).encode("utf-16"), "cut", f"line {N + 1}"),
        "no line end, whole": Doubtful(_SHORT.rstrip("\n"), "flight"),
        "a line too short inside": _refused(_PLAIN.replace("\n1.0,", "\n0.99,1.0,2.0\n1.0,"), "line 52: 3 columns"),
    }


def _units() -> dict[str, Doubtful]:
    said = {"convention": "ned"}
    return {
        "milliradians": _refused(
            table("t,yaw [mrad],pitch [mrad],roll [mrad]", TIME, *(1e3 * _x for _x in _RAD)),
            "in mrad: expected an angle in deg, rad or centideg",
        ),
        "rates": _refused(table("t,yaw [deg/s],pitch [deg/s],roll [deg/s]", TIME, *ANGLES.T), "in deg/s"),
        "turns": _refused(table("t,yaw (rev),pitch (rev),roll (rev)", TIME, *ANGLES.T / 360), "in rev"),
        "time in ticks": _refused(table("time [ticks],yaw,pitch,roll", TIME, *ANGLES.T), "in ticks: expected a stamp"),
        "time in tenths of ms": Doubtful(table("time [0.1 ms],yaw,pitch,roll", 1e4 * TIME, *ANGLES.T), "flight", said),
        "unit with a remark": Doubtful(
            table("time [s since start],yaw [rad body],pitch [rad body],roll [rad body]", TIME, *_RAD), "flight", said
        ),
        "a unit row that says other than the name": _refused(
            _PLAIN.replace("\n", "\ns,rad,rad,rad\n", 1), "in rad, named by deg: expected one unit"
        ),
        "units that differ": _refused(
            table("t,yaw_deg,pitch_deg,roll_rad", TIME, *ANGLES.T), "three angles in one unit"
        ),
        "all in radians": _warned(table(NAMES, TIME, *_RAD), "angle-unit"),
        "small in radians": _warned(table(NAMES, TIME, _ZERO, *(np.radians(0.02 * ANGLES.T[1:]))), "angle-unit"),
        "only bank moves, in radians": _warned(table(NAMES, TIME, _ZERO + 90, _ZERO, _RAD[2]), "angle-unit"),
        "heading moves in degrees, bank in radians": _warned(table(NAMES, TIME, HEADING, _ZERO, _RAD[2]), "angle-unit"),
        "bank turns on in radians": _warned(table(NAMES, TIME, HEADING, _RAD[1], 20 * TIME), "angle-unit"),
        "degrees said to be radians": _warned(
            table("t,yaw_rad,pitch_rad,roll_rad", TIME, *ANGLES.T), "pitch", "are the angles in degrees", **said
        ),
        "centidegrees": _warned(table(NAMES, TIME, *(100 * ANGLES.T)), "pitch", "centidegrees"),
        "gentle centidegrees": _warned(
            table(NAMES, TIME, *np.round(5 * ANGLES.T), digits="g"), "angle-unit", "centidegrees"
        ),
        "milliseconds": _warned(table(NAMES, 1e3 * TIME, *ANGLES.T), "time-unit"),
        "microseconds": _warned(table(NAMES, 1e6 * TIME, *ANGLES.T), "time-unit"),
        "nanoseconds since 1970": _refused(
            table(NAMES, 1.7e18 + 2e7 * np.arange(N), *ANGLES.T, digits=".0f"), "line 2, column time_s"
        ),
        "seconds since 1970": Doubtful(table(NAMES, 1.7e9 + TIME, *ANGLES.T, digits=".9f"), "flight"),
        "beyond a million degrees": _warned(table(NAMES, TIME, HEADING + 3.6e6, PITCH, BANK), "beyond-reason"),
        "pitch beyond a quarter turn": _warned(with_value(1, 60, 90.5), "pitch", "line 62"),
    }


def _turns() -> dict[str, Doubtful]:
    wraps = np.mod(HEADING + 300.0, 360.0)
    turned = Rotation.from_euler("ZYX", np.column_stack([HEADING + 300.0, PITCH, BANK]), degrees=True)
    signed = np.mod(HEADING + 300.0, 360.0) - 360.0 * (np.mod(HEADING + 300.0, 360.0) > 180.0)
    found = {
        "wraps at 360": Doubtful(table(NAMES, TIME, wraps, PITCH, BANK), "flight", truth=turned),
        "wraps at 180": Doubtful(table(NAMES, TIME, signed, PITCH, BANK), "flight", truth=turned),
    }
    for each in _SPIN:
        spin = table(NAMES, TIME, _ZERO, _ZERO, each * np.arange(N))
        found[f"{each:g} deg a sample, unwrapped"] = _warned(spin, "turns", "column bank_deg")
    found["150 deg a sample, wrapped"] = _warned(
        table(NAMES, TIME, _ZERO, _ZERO, np.mod(150.0 * np.arange(N), 360.0)), "step"
    )
    return found


def _signs() -> dict[str, Doubtful]:
    return {
        "full-width commas": _refused(_PLAIN.replace(",", "\uff0c"), "\\uff0c"),
        "a full-width digit": _refused(_PLAIN.replace("\n1.0,", "\n\uff11.0,"), "\\uff11"),
        "a minus that is none": _refused(_PLAIN.replace(",-", ",\u2212"), "\\u2212"),
        "no-break blanks": Doubtful(_PLAIN.replace(",pitch_deg", ",\u200bpitch_deg"), "invisible", place="\\u200b"),
        "duplicated column": _refused(table(NAMES + ",pitch_deg", TIME, *ANGLES.T, BANK), "each column once"),
        "two attitudes": _refused(table(NAMES + ",qw,qx,qy,qz", TIME, *ANGLES.T, *_Q), "one attitude"),
        "thousands": _refused(_PLAIN.replace(",", ";").replace(".", ",").replace("\n1,0;", "\n1.000,0;"), "line 52"),
        "decimal commas between commas": _refused(_PLAIN.replace(".", ","), "line 2"),
        "header after remarks": Doubtful("# made by a logger\n#\n% 3\n" + _PLAIN, "flight"),
        "nan": _refused(with_value(1, 60, np.nan), "line 62, column pitch_deg: nan"),
        "no value": _refused(_PLAIN.replace(f"1.0,{float(HEADING[50])!r}", "1.0,"), "line 52, column heading_deg"),
        "time runs backward": _refused(table(NAMES, np.where(TIME > 2.0, TIME - 1.0, TIME), *ANGLES.T), "backward"),
        "a stamp twice": _refused(table(NAMES, np.where(TIME == 1.0, 0.98, TIME), *ANGLES.T), "drop_duplicates"),
        "norm": _warned(table("t,qw,qx,qy,qz", TIME, *1.2 * _Q), "norm", convention="ned"),
        "zero quaternion": _refused(
            table("t,qw,qx,qy,qz", TIME, *_Q * (TIME != 1.0)), "line 52, column qw", convention="ned"
        ),
        "conventions that differ": _refused(_PLAIN, "convention ned", convention="nue"),
        "ROS names": Doubtful(
            table("time,qx,qy,qz,qw", TIME, *_ENU.as_quat().T), "flight", {"convention": "enu"}, _ENU, "enu"
        ),
        "yaw under ned": Doubtful(
            table("t,yaw_deg,pitch_deg,roll_deg", TIME, *ANGLES.T), "flight", {"convention": "ned"}
        ),
    }


DOUBTFUL = _orders() | _senses() | _sentinels() | _cut() | _units() | _turns() | _signs()
