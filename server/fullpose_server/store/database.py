"""The database: SQLite embedded in the data folder, or a PostgreSQL; migrated by Alembic when it is opened."""

from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from sqlalchemy import Connection, Engine, inspect, text
from sqlalchemy.exc import DBAPIError
from sqlalchemy.exc import TimeoutError as PoolTimeoutError
from sqlalchemy.orm import Session, sessionmaker

from fullpose_server.errors import DamagedError, ServerError, StorageBusyError, StorageError
from fullpose_server.location import Location, PostgresqlUrl
from fullpose_server.store import postgresql, sqlite
from fullpose_server.store.tables import Table

HEAD = "0009"  # the newest revision in migrations/versions
WAIT_S = 2.0  # for another program that holds it: the threads that wait here are not many
MIGRATIONS = Path(__file__).parent / "migrations"


class NewerDatabaseError(ServerError):
    """Another, newer version wrote it."""

    def __init__(self, location: Location, revision: str) -> None:
        instead = (
            "move the file away and put a backup of an earlier one in its place"
            if isinstance(location, Path)
            else "restore a backup of an earlier one into another database"
        )
        super().__init__(
            f"database {location} was written by a newer Fullpose (revision {revision}, this one knows {HEAD}): start"
            f" that one, or {instead}"
        )


class UnreachableDatabaseError(StorageError):
    """It cannot be opened as things are."""

    def __init__(self, location: PostgresqlUrl, why: DBAPIError) -> None:
        super().__init__(
            f"database {location} cannot be opened: {postgresql.told(why) or ' '.join(str(why.orig).split())}"
        )


class Database:
    """Sessions on it; synchronous: async callers go through a thread."""

    def __init__(self, location: Location, busy_s: float = WAIT_S) -> None:
        """Open it, or make it; held by another program, it is waited for, `busy_s` [s].

        Raises `DamagedError`, `NewerDatabaseError`, `StorageError`.
        """
        self._told = sqlite.told if isinstance(location, Path) else postgresql.told
        match location:
            case Path():
                self.engine = sqlite.engine(_owned(location), busy_s)
            case PostgresqlUrl():
                self.engine = postgresql.engine(location, busy_s)
        try:
            _prepare(self.engine, location)
        except BaseException:
            self.engine.dispose()
            raise
        self._sessions = sessionmaker(self.engine, expire_on_commit=False)

    @contextmanager
    def begin(self) -> Iterator[Session]:
        """One transaction: committed at the end, rolled back by an exception. Raises `StorageError`."""
        try:
            with self._sessions.begin() as session:
                yield session
        except DBAPIError as error:
            told = self._told(error)
            if told is None:
                raise
            raise told from error
        except PoolTimeoutError as error:
            raise StorageBusyError("the database is slow: every connection to it is in use") from error

    @contextmanager
    def begin_alone(self, *tables: type[Table]) -> Iterator[Session]:
        """Likewise one that has these tables to itself, from its first look on, but for who reads."""
        statement = (
            sqlite.ALONE if self.dialect == "sqlite" else postgresql.alone([each.__tablename__ for each in tables])
        )
        with self.begin() as session:
            session.execute(text(statement))
            yield session

    @contextmanager
    def begin_snapshot(self) -> Iterator[Session]:
        """Likewise one that sees everything as of one moment."""
        with self.begin() as session:
            session.execute(text(sqlite.SNAPSHOT if self.dialect == "sqlite" else postgresql.SNAPSHOT))
            yield session

    @property
    def dialect(self) -> str:
        """Of SQL: sqlite, postgresql."""
        return self.engine.dialect.name

    def close(self) -> None:
        """Close every connection; SQLite's write-ahead log is folded into the file."""
        self.engine.dispose()


def migrate(engine: Engine) -> None:
    """Bring the schema to the newest revision. Raises `NewerDatabaseError`."""
    if _revision_known(engine) == HEAD:
        return
    # Takes a tenth of the server's start to load, and has something to do once in a version's life.
    from alembic import command
    from alembic.config import Config

    config = Config()
    config.set_main_option("script_location", str(MIGRATIONS).replace("%", "%%"))
    with engine.begin() as connection:
        if engine.dialect.name == "postgresql":  # one at a time: a server and a command may begin together
            connection.execute(text(f"SELECT pg_advisory_xact_lock({postgresql.MIGRATING})"))
        config.attributes["connection"] = connection
        command.upgrade(config, "head")


def revision_of(connection: Connection) -> str | None:
    """The revision that a database has; None: it has no tables yet, or is no database of ours."""
    if not inspect(connection).has_table("alembic_version"):
        return None
    found = connection.scalar(text("SELECT version_num FROM alembic_version"))
    return None if found is None else str(found)


def _revision_known(engine: Engine) -> str | None:
    with engine.begin() as connection:
        revision = revision_of(connection)
    if revision is not None and revision > HEAD:
        raise NewerDatabaseError(location_of(engine), revision)
    return revision


def location_of(engine: Engine) -> Location:
    """Where an engine's database is."""
    if engine.dialect.name == "sqlite":
        return Path(str(engine.url.database))
    return PostgresqlUrl.of(engine.url.render_as_string(hide_password=False))


def _owned(path: Path) -> Path:
    path.parent.mkdir(parents=True, exist_ok=True)
    with suppress(OSError):  # SQLite says better what is wrong
        path.touch(mode=0o600, exist_ok=True)  # hashes of passwords are in it
        path.chmod(0o600)  # one that an earlier version made
    return path


def _prepare(engine: Engine, location: Location) -> None:
    """Check it, as far as there is something to check, and bring it up."""
    try:
        if isinstance(location, PostgresqlUrl):
            patient = postgresql.patient_engine(location, changes=True)
            try:
                migrate(patient)
            finally:
                patient.dispose()
        else:
            sqlite.check(engine)
            migrate(engine)
    except DBAPIError as error:
        if isinstance(location, PostgresqlUrl):
            raise UnreachableDatabaseError(location, error) from error
        told = sqlite.told(error)
        if told is None:  # tables that are not the ones that its revision has
            told = DamagedError(f"the database is damaged: {error.orig}")
        raise told from error
