"""How a rig file says its rig is operated: [drive], [guard], [motion], [silence.owner], [silence.server], [process].

Every key may be left out and is then as the defaults have it. Only in a tolerance of [guard] a level that is left out
is off.
"""

from dataclasses import fields, replace
from typing import Any

from fullpose_server.formats.rig_keys import bad, is_number, number, only, table_of, whole
from fullpose_server.operating import ConfigError, GuardConfig, MotionConfig, OperatingConfig, Tolerance
from fullpose_server.session.machine import SilencePolicy

TABLES = ("drive", "guard", "motion", "silence", "process")
TOLERANCES = tuple(f.name for f in fields(GuardConfig) if f.type is Tolerance)
SILENCES = ("owner", "server")
PROCESS = ("realtime_priority", "cpu", "min_free_mb")


def read_operating(table: dict[str, Any], file: str, defaults: OperatingConfig) -> OperatingConfig:
    """`defaults` with what the parsed rig file `table` says. Raises `FileError`.

    A drive's name and options are checked where the drive is made: its package need not be where plans are made.
    """
    given = {name: table_of(table[name], name, file) for name in TABLES if name in table}
    changes: dict[str, Any] = {}
    if "drive" in given:
        changes |= _drive(given["drive"], file)
    if "guard" in given:
        changes["guard"] = _guard(given["guard"], file, defaults.guard)
    if "motion" in given:
        changes["motion"] = _numbers(given["motion"], "motion", file, defaults.motion)
    if "silence" in given:
        only(given["silence"], SILENCES, "silence.", file)
        for name in given["silence"]:
            where = f"silence.{name}"
            policy = table_of(given["silence"][name], where, file)
            changes[name] = _silence(policy, where, file, getattr(defaults, name))
    if "process" in given:
        changes |= _process(given["process"], file)
    try:
        return replace(defaults, **changes)
    except ConfigError as error:
        where = "drive.name" if error.field == "drive" else f"process.{error.field}"
        raise bad(file, where, error.value, error.expected) from None


def _drive(table: dict[str, Any], file: str) -> dict[str, Any]:
    name = table.get("name")
    if not isinstance(name, str):
        raise bad(file, "drive.name", name, "a drive's name, such as 'udp'")
    options = {key: value for key, value in table.items() if key != "name"}
    _plain(options, "drive", file)
    return {"drive": name, "drive_options": options}


def _plain(value: Any, where: str, file: str) -> None:
    """Refuse what would not reach the rig process as it is: it is told by JSON."""
    if isinstance(value, dict):
        for key, inner in value.items():
            _plain(inner, f"{where}.{key}", file)
    elif isinstance(value, list):
        for inner in value:
            _plain(inner, where, file)
    elif not isinstance(value, (str, bool)) and not is_number(value):
        raise bad(file, where, value, "text, true or false, a finite number, or lists and tables of these")


def _guard(table: dict[str, Any], file: str, base: GuardConfig) -> GuardConfig:
    only(table, [f.name for f in fields(GuardConfig)], "guard.", file)
    changes: dict[str, Any] = {}
    for key, value in table.items():
        where = f"guard.{key}"
        if key not in TOLERANCES:
            changes[key] = number(value, where, file)
            continue
        levels = table_of(value, where, file, "levels such as {warn = 1.0, trip = 3.0}; one that is left out is off")
        only(levels, ("warn", "trip"), f"{where}.", file)
        read = {name: number(level, f"{where}.{name}", file) for name, level in levels.items()}
        try:
            changes[key] = Tolerance(read.get("warn"), read.get("trip"))
        except ConfigError as error:
            raise bad(file, f"{where}.{error.field}", error.value, error.expected) from None
    try:
        return replace(base, **changes)
    except ConfigError as error:
        raise bad(file, f"guard.{error.field}", error.value, error.expected) from None


def _numbers(table: dict[str, Any], where: str, file: str, base: MotionConfig) -> MotionConfig:
    only(table, [f.name for f in fields(base)], f"{where}.", file)
    try:
        return replace(base, **{key: number(value, f"{where}.{key}", file) for key, value in table.items()})
    except ConfigError as error:
        raise bad(file, f"{where}.{error.field}", error.value, error.expected) from None


def _silence(table: dict[str, Any], where: str, file: str, base: SilencePolicy) -> SilencePolicy:
    names = [f.name for f in fields(SilencePolicy)]
    only(table, names, f"{where}.", file)
    times = {name: getattr(base, name) for name in names}
    times |= {key: number(value, f"{where}.{key}", file) for key, value in table.items()}
    try:
        return SilencePolicy(**times)
    except ValueError:
        raise bad(file, where, times, "0 < hold_s < stop_s < disarm_s") from None


def _process(table: dict[str, Any], file: str) -> dict[str, Any]:
    only(table, PROCESS, "process.", file)
    changes: dict[str, Any] = {}
    for key, value in table.items():
        where = f"process.{key}"
        if key == "min_free_mb":
            changes[key] = number(value, where, file)
        elif key == "realtime_priority" and value is False:
            changes[key] = None
        elif key == "realtime_priority":
            changes[key] = whole(value, where, file, "1 to 99, or false for ordinary scheduling")
        else:
            changes[key] = whole(value, where, file)
    return changes
