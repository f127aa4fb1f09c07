"""Which columns of a file are the flight: what a person says, or the first profile that fits, and the reason."""

from dataclasses import dataclass

from pydantic import ValidationError

from fullpose_server.errors import FileError
from fullpose_server.formats.column_map import ColumnMap
from fullpose_server.formats.importers.table import Table
from fullpose_server.formats.profile import Profile, find, find_profile, shipped
from fullpose_server.formats.read_options import AS_IT_IS, ReadOptions
from fullpose_server.formats.sources import check_one, of_source
from fullpose_server.formats.trajectory import Convention
from fullpose_server.formats.visible import visible


@dataclass(frozen=True)
class Choice:
    """A table, the map of its columns, the profile's name, and why it was taken."""

    table: Table
    columns: ColumnMap
    profile: str
    reason: str
    assumed: str | None = None  # what neither the file nor a person says, and is doubtful


OWN = ("fullpose", "fullpose-ned", "fullpose-quaternion")


def choose(tables: tuple[Table, ...], options: ReadOptions = AS_IT_IS) -> Choice:
    """The table and map of a file. Raises `FileError` where nothing fits."""
    convention = options.convention
    tables = of_source(tables, options.source)
    if options.columns is not None:
        return _as_told(tables, options.columns)
    if options.profile is not None:
        return _given(tables, convention, find_profile(options.profile))
    fitting = [choice for table in tables if (choice := _guessed(table, convention)) is not None]
    check_one([choice.table for choice in fitting])
    if not fitting:
        raise _nothing_fits(tables[0], convention)
    return fitting[0]


def _guessed(table: Table, convention: Convention | None) -> Choice | None:
    """The first profile that fits a table; None where none does."""
    _check_one_attitude(table)
    for each in _candidates(table):
        if (columns := each.bind(table, convention)) is None:
            continue
        if not _allowed(each, convention):
            raise _other_axes(table, each, convention)
        _check_once(table, columns)
        said = convention is not None or each.axes_named
        assumed = None if said or each.name in OWN else _assumed(each)
        return Choice(table, columns, each.name, _reason(table, each, said), assumed)
    return None


def _as_told(tables: tuple[Table, ...], text: str) -> Choice:
    """The map that a person has made, of the first table that has its columns."""
    try:
        columns = ColumnMap.model_validate_json(text)
    except ValidationError as error:
        first = error.errors(include_url=False)[0]
        key = ".".join(str(part) for part in first["loc"])
        raise FileError("columns", first["msg"], column=key or None, column_word="key") from None
    fitting = [table for table in tables if all(name in table.names for name in columns.columns)]
    check_one(fitting)
    for table in fitting:
        _check_once(table, columns)
        return Choice(table, columns, "", "as told")
    missing = next(name for name in columns.columns if name not in tables[0].names)
    raise tables[0].error(f"a column {missing} among {listing(tables[0].names)}", missing)


def _assumed(profile: Profile) -> str:
    taken = f"the axes are assumed to be {profile.axes}, as profile {profile.name} has it"
    return f"{taken}: give the convention if they are others"


def _given(tables: tuple[Table, ...], convention: Convention | None, profile: Profile) -> Choice:
    named = [table for table in tables if profile.table is None or len(tables) == 1 or table.name in profile.table]
    fitting = [table for table in named if profile.bind(table, convention) is not None]
    check_one(fitting)
    for table in fitting:
        if (columns := profile.bind(table, convention)) is not None:
            if not _allowed(profile, convention):
                raise _other_axes(table, profile, convention)
            _check_once(table, columns)
            return Choice(table, columns, profile.name, f"profile {profile.name}, as asked for")
    table = tables[0]
    missing = profile.missing(table)
    raise table.error(f"{', '.join(missing)} of profile {profile.name} among {listing(table.names)}", missing[0])


def _candidates(table: Table) -> list[Profile]:
    profiles = shipped()
    own = [profiles[table.profile]] if table.profile in profiles else []
    return own + [
        each
        for each in profiles.values()
        if each.guessed
        and (each.table is None or table.name in each.table)
        and all(find(table, (name,)) is not None for name in each.also)
    ]


def _allowed(profile: Profile, convention: Convention | None) -> bool:
    return convention is None or convention is profile.axes or not profile.axes_named


def _reason(table: Table, profile: Profile, said: bool) -> str:
    by = f"as {table.format} has it" if table.profile == profile.name else "by its column names"
    if said:
        return f"profile {profile.name}, {by}"
    turned = "; its yaw is counted to the left, opposite to a heading" if profile.name == OWN[0] else ""
    return f"profile {profile.name}, {by}; no convention was given, {profile.axes} is taken{turned}"


def _check_one_attitude(table: Table) -> None:
    """Raise `FileError` where a file has two of our own attitudes: which of them is meant is nobody's guess."""
    profiles = shipped()
    present = [[name for name in _attitude(profiles[each]) if name in table.names] for each in OWN]
    euler, q = [*dict.fromkeys(present[0] + present[1])], present[2]
    if euler and q and "time_s" in table.names:
        raise table.error("one attitude, Euler angles or quaternion", value=f"{', '.join(euler)} and {', '.join(q)}")


def _attitude(profile: Profile) -> list[str]:
    return [spellings[0] for spellings in profile.wanted[1:]]


def _check_once(table: Table, columns: ColumnMap) -> None:
    for name in columns.columns:
        if table.names.count(name) > 1:
            raise table.error("each column once", name)


def _other_axes(table: Table, profile: Profile, convention: Convention | None) -> FileError:
    names = ", ".join(_attitude(profile))
    return table.error(f"convention {profile.axes} for {names}", value=f"convention {convention}")


def _nothing_fits(table: Table, convention: Convention | None) -> FileError:
    profiles = shipped()
    for each in profiles.values():
        if each.guessed and each.bind(table) is not None:
            return _other_axes(table, each, convention)
    among = listing(table.names) if table.format == "csv" else f"{listing(table.names)} of {table.format} {table.name}"
    if find(table, ("time_s",)) is None:
        says = ("profile", "says which columns are what")
        return table.error(f"a column time_s among {among}".rstrip(), "time_s", otherwise=says)
    own = profiles["fullpose-ned" if convention is Convention.NED else "fullpose"]
    q = profiles["fullpose-quaternion"]
    nearer = q if len(q.missing(table)) < 4 else own
    expected = f"{', '.join(_attitude(own))} or {', '.join(_attitude(q))} among {among}"
    return table.error(expected.rstrip(), nearer.missing(table)[0])


def listing(names: tuple[str, ...]) -> str:
    """Column names for a message, not too many of them."""
    shown = ", ".join(visible(name) or "(unnamed)" for name in names[:12])
    return f"{shown}, ... ({len(names)} columns)" if len(names) > 12 else shown or "no columns at all"
