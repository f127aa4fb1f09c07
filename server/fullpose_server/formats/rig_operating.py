"""How a rig file says its rig is operated: [drive], [guard], [motion], [silence.owner], [silence.server], [process].

Every key may be left out and is then as the defaults have it. Only in a tolerance of [guard] a level that is left out
is off.
"""

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import asdict, fields, replace
from typing import Any

from pydantic import BaseModel

from fullpose_server.formats.rig_document import DriveTable, ProcessTable, RigDocument, ToleranceTable
from fullpose_server.formats.rig_keys import bad
from fullpose_server.operating import ConfigError, GuardConfig, OperatingConfig, Tolerance
from fullpose_server.session.machine import SilencePolicy

TOLERANCES = tuple(f.name for f in fields(GuardConfig) if f.type in (Tolerance, Tolerance | None))
PROCESS = tuple(ProcessTable.model_fields)


def operating_of(read: RigDocument, file: str, defaults: OperatingConfig) -> OperatingConfig:
    """`defaults` with what a rig file says. Raises `FileError`.

    A drive's name and options are checked where the drive is made: its package need not be where plans are made.
    """
    said = _given(read)
    changes: dict[str, Any] = {} if read.drive is None else _drive(read.drive)
    for part in said.keys() & {"guard", "motion"}:
        changes[part] = _changed(getattr(defaults, part), said[part], part, file)
    for name, policy in _given(read.silence).items():
        changes[name] = _silence(_given(policy), f"silence.{name}", file, getattr(defaults, name))
    changes |= {key: None if value is False else value for key, value in _given(read.process).items()}
    with _named(file, lambda field: "drive.name" if field == "drive" else f"process.{field}"):
        return replace(defaults, **changes)


def _given(table: BaseModel | None) -> dict[str, Any]:
    """What a table says, by key, in the order that they are declared in."""
    if table is None:
        return {}
    return {key: getattr(table, key) for key in type(table).model_fields if key in table.model_fields_set}


def _drive(table: DriveTable) -> dict[str, Any]:
    return {"drive": table.name, "drive_options": table.model_extra or {}}


@contextmanager
def _named(file: str, key_of: Any) -> Iterator[None]:
    """A value that a dataclass refuses is an error of the key that says it."""
    try:
        yield
    except ConfigError as error:
        raise bad(file, key_of(error.field), error.value, error.expected) from None


def _changed(base: Any, table: BaseModel, where: str, file: str) -> Any:
    """The dataclass `base` with what a table of numbers and tolerances says."""
    changes: dict[str, Any] = {}
    for key, value in _given(table).items():
        changes[key] = value
        if isinstance(value, ToleranceTable):
            with _named(file, lambda field, key=key: f"{where}.{key}.{field}"):
                changes[key] = Tolerance(value.warn, value.trip)
    with _named(file, lambda field: f"{where}.{field}"):
        return replace(base, **changes)


def _silence(given: dict[str, Any], where: str, file: str, base: SilencePolicy) -> SilencePolicy:
    times = asdict(base) | given
    try:
        return SilencePolicy(**times)
    except ValueError:
        raise bad(file, where, times, "0 < hold_s < stop_s < disarm_s") from None
