"""Named profiles: a column map for each tool's files, with the spellings that its versions have (TOML)."""

import re
import tomllib
from functools import cache
from importlib.resources import files
from pathlib import Path
from typing import Annotated, TypeVar

from pydantic import BaseModel, BeforeValidator, ConfigDict, Field, ValidationError, model_validator

from fullpose_server.errors import FileError
from fullpose_server.formats.column_map import (
    AngleUnit,
    ColumnMap,
    ColumnName,
    Epoch,
    EulerMap,
    Order,
    QuaternionMap,
    Sense,
    TimeMap,
    TimeUnit,
)
from fullpose_server.formats.importers.table import Table, unit_in_name
from fullpose_server.formats.trajectory import Convention
from fullpose_server.formats.units import angle_unit, is_other, time_unit
from fullpose_server.formats.visible import visible

Unit = TypeVar("Unit", TimeUnit, AngleUnit)
# A column by the names that it goes by; one name may be given as a text.
Spellings = Annotated[
    tuple[ColumnName, ...],
    BeforeValidator(lambda given: (given,) if isinstance(given, str) else given),
    Field(min_length=1),
]


class _Part(BaseModel):
    model_config = ConfigDict(frozen=True, extra="forbid")


class TimeProfile(_Part):
    """The stamps."""

    column: Spellings
    unit: TimeUnit | None = None  # None: as the file says, seconds where it does not
    epoch: Epoch = Epoch.FILE


class EulerProfile(_Part):
    """Three turns."""

    columns: tuple[Spellings, Spellings, Spellings]
    order: Order
    unit: AngleUnit | None = None  # None: as the file says, degrees where it does not


class QuaternionProfile(_Part):
    """A quaternion, w, x, y, z."""

    columns: tuple[Spellings, Spellings, Spellings, Spellings]
    sense: Sense = Sense.BODY_TO_REFERENCE


class Profile(_Part):
    """A column map with spellings, and what it is for."""

    name: str = ""
    about: str = ""
    rank: int = 100  # the least is tried first
    axes: Convention
    axes_named: bool = False  # the names or the format say the axes; a person cannot say others
    also: tuple[ColumnName, ...] = ()  # columns that such a file has beside those that are read
    guessed: bool = True  # whether it may be taken without being asked for
    table: Spellings | None = None  # of a file with several; None: any
    time: TimeProfile
    euler: EulerProfile | None = None
    quaternion: QuaternionProfile | None = None

    @model_validator(mode="after")
    def _one_attitude(self) -> "Profile":
        if (self.euler is None) == (self.quaternion is None):
            raise ValueError("expected one attitude, euler or quaternion")
        return self

    @property
    def wanted(self) -> tuple[Spellings, ...]:
        """Every column, the time first."""
        part = self.euler or self.quaternion
        return (self.time.column, *(() if part is None else part.columns))

    def missing(self, table: Table) -> tuple[str, ...]:
        """Those of its columns that a table lacks, by their first spelling."""
        return tuple(spellings[0] for spellings in self.wanted if find(table, spellings) is None)

    def bind(self, table: Table, convention: Convention | None = None) -> ColumnMap | None:
        """The map of the table's own names, in the axes that a person says; None where a column is missing."""
        names = [find(table, spellings) for spellings in self.wanted]
        found = [name for name in names if name is not None]
        if len(found) < len(names):
            return None
        axes = convention or self.axes
        clock = self.time.unit or stamp_unit(table, found[0]) or TimeUnit.S
        time = TimeMap(column=found[0], unit=clock, epoch=self.time.epoch)
        if self.euler is None:
            w, x, y, z = found[1:]
            sense = Sense.BODY_TO_REFERENCE if self.quaternion is None else self.quaternion.sense
            return ColumnMap(axes=axes, time=time, quaternion=QuaternionMap(columns=(w, x, y, z), sense=sense))
        first, second, third = found[1:]
        unit = self.euler.unit or shared_angle_unit(table, found[1:]) or AngleUnit.DEG
        order = in_axes(self.euler.order, self.axes, axes)
        euler = EulerMap(columns=(first, second, third), order=order, unit=unit)
        return ColumnMap(axes=axes, time=time, euler=euler)


def in_axes(order: Order, of: Convention, to: Convention) -> Order:
    """The order of the same turns where up is another axis: yaw, pitch, roll are YZX in ours and ZYX in the others."""
    if (of is Convention.NUE) == (to is Convention.NUE):
        return order
    swapped: Order = order.translate(str.maketrans("YZ", "ZY"))  # type: ignore[assignment]
    return swapped


def stamp_unit(table: Table, name: str) -> TimeUnit | None:
    """The unit of time that a file gives a column: said, or at the end of its name (`t_ms`). Raises `FileError`."""
    if is_other(table.unit(name), of_time=True):
        raise table.error("a stamp in s, ms, us, ns, min or h", name, f"in {visible(str(table.unit(name)))}")
    return _agreed(table, name, time_unit(table.unit(name)), time_unit(_ending(name)))


def shared_angle_unit(table: Table, names: list[str]) -> AngleUnit | None:
    """The unit of angle that a file gives three columns. Raises `FileError` where it gives them several, or one that
    is not read."""
    units: dict[AngleUnit, str] = {}
    for name in names:
        if is_other(table.unit(name), of_time=False):
            raise table.error("an angle in deg, rad or centideg", name, f"in {visible(str(table.unit(name)))}")
        if (unit := _agreed(table, name, angle_unit(table.unit(name)), angle_unit(_ending(name)))) is not None:
            units[unit] = name
    if len(units) > 1:
        said = ", ".join(f"{name} in {unit}" for unit, name in units.items())
        raise table.error("three angles in one unit", value=said)
    return next(iter(units), None)


def _agreed(table: Table, name: str, said: Unit | None, named: Unit | None) -> Unit | None:
    """The unit that a column is said to have, or is named by; they may not differ."""
    if said is not None and named is not None and said != named:
        raise table.error("one unit", name, f"in {said}, named by {named}")
    return said or named


def find(table: Table, spellings: Spellings) -> str | None:
    """The table's name of a column: the very spelling, else what differs in capitals, blanks or a unit in brackets,
    else one whose path ends so (`/imu/orientation/x` for `orientation.x`)."""
    for spelling in spellings:
        if spelling in table.names:
            return spelling
    plain = {_plain(name): name for name in reversed(table.names)}
    for spelling in spellings:
        if (found := plain.get(_plain(spelling))) is not None:
            return found
    for spelling in spellings:
        ending = "/" + _plain(spelling)
        if several := [name for known, name in plain.items() if known.endswith(ending)]:
            return several[0] if len(several) == 1 else None
    return None


def _plain(name: str) -> str:
    words = " ".join(unit_in_name(name)[0].casefold().replace("_", " ").split())
    return re.sub(r"(?<=[^\d\W])\.(?=[^\W])", "/", words)


def _ending(name: str) -> str | None:
    return unit_in_name(name)[0].replace(" ", "_").rpartition("_")[2] or None


@cache
def shipped() -> dict[str, Profile]:
    """The profiles that come with the package by name, those to be tried first before the others."""
    found = [
        _parsed(path.read_text(encoding="utf-8"), path.name, path.name.removesuffix(".toml"))
        for path in files("fullpose_server.formats").joinpath("profiles").iterdir()
        if path.name.endswith(".toml")
    ]
    return {each.name: each for each in sorted(found, key=lambda each: (each.rank, each.name))}


def find_profile(name: str) -> Profile:
    """A shipped profile by name, or that of a TOML file. Raises `FileError`."""
    if name in shipped():
        return shipped()[name]
    if not name.endswith(".toml"):
        raise FileError("profile", f"a TOML file or one of {', '.join(shipped())}", value=repr(name[:60]))
    try:
        text = Path(name).read_text(encoding="utf-8")
    except UnicodeDecodeError as error:
        raise FileError(name, f"TOML text in UTF-8 ({error})") from None
    return _parsed(text, name, Path(name).stem)


def _parsed(text: str, file: str, name: str) -> Profile:
    try:
        return Profile.model_validate({"name": name, **tomllib.loads(text)})
    except tomllib.TOMLDecodeError as error:
        raise FileError(file, f"TOML ({error})") from None
    except ValidationError as error:
        first = error.errors(include_url=False)[0]
        key = ".".join(str(part) for part in first["loc"])
        raise FileError(
            file, first["msg"].removeprefix("Value error, "), column=key or None, column_word="key"
        ) from None
