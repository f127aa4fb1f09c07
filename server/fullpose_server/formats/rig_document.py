"""The rig file, declared once: reading and its errors, writing, the JSON schema and the API's frames come from here.

Degrees and seconds, as in the file. How a rig is operated is declared in `fullpose_server.operating`; its tables here
are made from those dataclasses.
"""

import math
import re
from collections.abc import Callable, Iterator
from dataclasses import fields
from typing import Annotated, Any, Literal, NamedTuple, TypeAlias

from pydantic import BaseModel, BeforeValidator, ConfigDict, ValidationError, create_model

from fullpose.rig import FrameLimits, Geometry
from fullpose_server.errors import FileError
from fullpose_server.formats.degrees import written_degrees
from fullpose_server.formats.rig_keys import bad, is_number
from fullpose_server.operating import GuardConfig, MotionConfig, Tolerance
from fullpose_server.session.machine import SilencePolicy


class Expected(NamedTuple):
    """What a key should be, in the words of its error."""

    text: str


class Table(BaseModel):
    """A table of the file: it knows its keys, and no others."""

    model_config = ConfigDict(extra="forbid", frozen=True)


def _checked(right: Callable[[Any], bool], expected: str) -> BeforeValidator:
    def check(value: Any) -> Any:
        if not right(value):
            raise ValueError(expected)
        return value

    return BeforeValidator(check)


def _number(expected: str = "a finite number") -> Any:
    return Annotated[float, _checked(is_number, expected)]


def _integer(expected: str = "a whole number") -> Any:
    return Annotated[int, _checked(lambda value: isinstance(value, int) and is_number(value), expected)]


def _text(expected: str) -> Any:
    return Annotated[str, _checked(lambda value: isinstance(value, str), expected), Expected(expected)]


def _size(value: Any) -> Any:
    if not isinstance(value, list | tuple) or len(value) != 3:
        raise ValueError("three lengths [m]")
    if not all(is_number(length) and length > 0.0 for length in value):
        raise ValueError("lengths above zero [m]")
    return value


def _priority(value: Any) -> Any:
    if value is not False and not (isinstance(value, int) and is_number(value)):
        raise ValueError("1 to 99, or false for ordinary scheduling")
    return value


Number: TypeAlias = _number()  # type: ignore[valid-type]
Limit: TypeAlias = _number("a finite number; leave the key out for no limit")  # type: ignore[valid-type]
Size: TypeAlias = Annotated[tuple[float, float, float], BeforeValidator(_size)]
Priority: TypeAlias = Annotated[int | Literal[False], BeforeValidator(_priority)]


class FrameTable(Table):
    """One frame. No key, no limit; without both positions it turns without end."""

    min_deg: Limit | None = None
    max_deg: Limit | None = None
    max_rate_deg_s: Limit | None = None
    max_acceleration_deg_s2: Limit | None = None
    max_jerk_deg_s3: Limit | None = None
    weight: Limit = 1.0
    home_deg: Limit = 0.0


# Key in the file -> field of `FrameLimits`; all in degrees but the weight.
FRAME_KEYS = {key: re.sub(r"_deg(_s[23]?)?$", "", key) for key in FrameTable.model_fields}

A_FRAME = Expected("a table")


class FramesTable(Table):
    """The frames from the outside in; a three-axis rig has no base."""

    base: Annotated[FrameTable, A_FRAME] = FrameTable()
    outer: Annotated[FrameTable, A_FRAME] = FrameTable()
    middle: Annotated[FrameTable, A_FRAME] = FrameTable()
    inner: Annotated[FrameTable, A_FRAME] = FrameTable()


class PayloadTable(Table):
    """What the rig carries: a box, or a mesh file beside the rig file."""

    size_m: Size | None = None
    mesh: _text("a file name") | None = None  # type: ignore[valid-type]


class DriveTable(BaseModel):
    """The drive's name; every other key is an option of its own, which the drive checks where it is made."""

    model_config = ConfigDict(extra="allow", frozen=True)
    name: _text("a drive's name, such as 'udp'")  # type: ignore[valid-type]


class ToleranceTable(Table):
    """Two levels of one check; one that is left out is off."""

    warn: Number | None = None
    trip: Number | None = None


LEVELS = Expected("levels such as {warn = 1.0, trip = 3.0}; one that is left out is off")


_TOLERANCES = (Tolerance, Tolerance | None)


def _table_of(name: str, config: type[Any]) -> type[Table]:
    """A table with a key for every field of a dataclass of numbers and tolerances; each may be left out."""
    keys: dict[str, Any] = {
        f.name: (Annotated[ToleranceTable | None, LEVELS] if f.type in _TOLERANCES else Number | None, None)
        for f in fields(config)
    }
    return create_model(name, __base__=Table, __doc__=config.__doc__, **keys)


GuardTable = _table_of("GuardTable", GuardConfig)
MotionTable = _table_of("MotionTable", MotionConfig)
SilencePolicyTable = _table_of("SilencePolicyTable", SilencePolicy)
A_TABLE = Expected("a table")


class SilenceTable(Table):
    """When a silent owner of the lease, or a silent server, means hold, stop and disarm."""

    owner: Annotated[SilencePolicyTable | None, A_TABLE] = None  # type: ignore[valid-type]
    server: Annotated[SilencePolicyTable | None, A_TABLE] = None  # type: ignore[valid-type]


class ProcessTable(Table):
    """The rig's process."""

    realtime_priority: Priority | None = None
    cpu: _integer() | None = None  # type: ignore[valid-type]
    min_free_mb: Number | None = None


class RigDocument(Table):
    """A rig file."""

    name: Annotated[str, _checked(lambda value: isinstance(value, str) and value != "", "a name"), Expected("a name")]
    geometry: Annotated[Geometry, Expected("one of " + ", ".join(Geometry))]
    frames: Annotated[FramesTable, Expected("tables such as [frames.outer]")] = FramesTable()
    payload: Annotated[PayloadTable, A_TABLE] = PayloadTable()
    drive: Annotated[DriveTable | None, A_TABLE] = None
    guard: Annotated[GuardTable | None, A_TABLE] = None  # type: ignore[valid-type]
    motion: Annotated[MotionTable | None, A_TABLE] = None  # type: ignore[valid-type]
    silence: Annotated[SilenceTable | None, A_TABLE] = None
    process: Annotated[ProcessTable | None, A_TABLE] = None


def document(table: dict[str, Any], file: str) -> RigDocument:
    """The document of a parsed file. Raises `FileError` by key, value and what was expected; `file` is for messages."""
    try:
        read = RigDocument.model_validate(table)
    except ValidationError as error:
        raise _told(error, file) from None
    if read.drive is not None:
        _check_plain(read.drive.model_extra or {}, "drive", file)
    return read


def _told(error: ValidationError, file: str) -> FileError:
    """What is wrong with the first key of which something is."""
    found = error.errors()[0]
    path = [str(part) for part in found["loc"] if isinstance(part, str)]
    key, value = ".".join(path), found["input"]
    if found["type"] == "extra_forbidden":
        *above, name = path
        known = _model_at(above).model_fields
        return bad(file, key, name, "one of " + ", ".join(sorted(known)))
    if found["type"] == "value_error":
        return bad(file, key, value, str(found["ctx"]["error"]))
    *above, name = path
    said = next(said.text for said in _model_at(above).model_fields[name].metadata if isinstance(said, Expected))
    return bad(file, key, None if found["type"] == "missing" else value, said)


def _model_at(path: list[str]) -> type[BaseModel]:
    """The table of a path of keys."""
    model: type[BaseModel] = RigDocument
    for name in path:
        model = next(_models_in(model.model_fields[name].annotation))
    return model


def _models_in(annotation: Any) -> Iterator[type[BaseModel]]:
    if isinstance(annotation, type) and issubclass(annotation, BaseModel):
        yield annotation
    for part in getattr(annotation, "__args__", ()):
        yield from _models_in(part)


def _check_plain(value: Any, where: str, file: str) -> None:
    """Refuse what would not reach the rig process as it is: it is told by JSON."""
    if isinstance(value, dict):
        for key, inner in value.items():
            _check_plain(inner, f"{where}.{key}", file)
    elif isinstance(value, list):
        for inner in value:
            _check_plain(inner, where, file)
    elif not isinstance(value, (str, bool)) and not is_number(value):
        raise bad(file, where, value, "text, true or false, a finite number, or lists and tables of these")


def frame_values(limits: FrameLimits) -> dict[str, float | None]:
    """A frame by the keys of the file; None: no limit."""

    def told(key: str, value: float) -> float | None:
        if not math.isfinite(value):
            return None
        return value if key == "weight" else written_degrees(value)

    return {key: told(key, getattr(limits, field)) for key, field in FRAME_KEYS.items()}


def frame_limits(frame: FrameTable) -> FrameLimits:
    """The inverse of `frame_values`: degrees of the file, radians in `fullpose`."""
    given = {key: value for key, value in frame if value is not None}
    return FrameLimits(**{FRAME_KEYS[k]: v if k == "weight" else math.radians(v) for k, v in given.items()})
