"""Where in a list a row stands: newest first, and by its id where two are of the same moment."""

from typing import Any, NamedTuple, TypeVar

from sqlalchemy import ColumnElement, Select, literal, or_, tuple_

from fullpose_server.formats.labels import Wanted

_Query = TypeVar("_Query", bound=Select[Any])


class Key(NamedTuple):
    """Of a row."""

    created: float  # [s] since 1970
    id: str


def newest_first(query: _Query, moment: Any, key: Any, before: Key | None, limit: int | None) -> _Query:
    """The query's rows in order of the columns `moment` and `key`, those after the one at `before`, at most `limit`."""
    if before is not None:
        query = query.where(tuple_(moment, key) < tuple_(literal(before.created), literal(before.id)))
    query = query.order_by(moment.desc(), key.desc())
    return query if limit is None else query.limit(limit)


def searched(wanted: Wanted, *columns: Any) -> list[ColumnElement[bool]]:
    """The conditions that each part of what is wanted is in one of the columns, search texts."""
    return [or_(*(column.contains(part, autoescape=True) for column in columns)) for part in wanted.parts]
