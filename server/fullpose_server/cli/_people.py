"""The people of a data folder, for commands that change them: a server that runs on it sees that within a second."""

import os
import pwd
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from datetime import UTC, datetime
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

if TYPE_CHECKING:
    from fullpose_server.store.database import Database
    from fullpose_server.store.people import PeopleStore

DataDir = Annotated[Path | None, typer.Option(help="The server's data folder (~/.local/share/fullpose).")]
UserName = Annotated[str, typer.Argument(metavar="NAME", help="Who: letters, digits or . @ : + - _")]


@contextmanager
def people_of(data_dir: Path | None, config: Path | None) -> Iterator["PeopleStore"]:
    """The people of a server's data folder, which is made where it is not there yet. Raises `ServerError`."""
    with _database(data_dir, config) as database:
        yield _store(database)


@contextmanager
def _database(data_dir: Path | None, config: Path | None) -> Iterator["Database"]:
    from fullpose_server.cli._configuration import configured
    from fullpose_server.store.database import Database

    database = Database(configured(data_dir=data_dir, config=config).settings.database)
    try:
        yield database
    finally:
        database.close()


def _store(database: "Database") -> "PeopleStore":
    from fullpose_server.store.people import PeopleStore

    return PeopleStore(database)


@contextmanager
def changing_people(
    data_dir: Path | None, config: Path | None
) -> Iterator[tuple["PeopleStore", Callable[[str, str], None]]]:
    """Likewise, to change them; and what writes a change, and about whom, into the audit: who has this terminal did it.

    Raises `ServerError`.
    """
    from fullpose_server.store.audit import AuditLog
    from fullpose_server.store.audit_entry import of_no_rig

    with _database(data_dir, config) as database:
        log, people = AuditLog(database), _store(database)

        def audit(word: str, about: str) -> None:
            log.write([of_no_rig(_who(), word, {"about": about}, None)])

        yield people, audit


def _who() -> str:
    """Of the system's users; no name of a person who signs in has a blank in it."""
    try:
        return f"{pwd.getpwuid(os.getuid()).pw_name} (command line)"
    except KeyError:
        return f"user {os.getuid()} (command line)"


def day(moment: float | None) -> str:
    """A time [s since 1970] for a table."""
    return "-" if moment is None else datetime.fromtimestamp(moment, UTC).strftime("%Y-%m-%d %H:%M")
