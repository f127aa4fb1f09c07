"""PostgreSQL as the store uses it, through psycopg 3: no call waits longer for it than for a locked file."""

import json
import os
import socket
import threading
import time
from collections.abc import Iterable
from contextlib import suppress
from typing import Any

from sqlalchemy import Connection, Engine, Table, create_engine, event, func, make_url, select, text
from sqlalchemy.exc import DBAPIError, DisconnectionError, OperationalError
from sqlalchemy.pool import NullPool

from fullpose_server.errors import ServerError, StorageBusyError, StorageError, StorageFullError
from fullpose_server.location import NO_DRIVER, PostgresqlUrl
from fullpose_server.store.tables import NUL, SHOWN

CONNECT_S = 3  # libpq takes no less than 2
STATEMENT_S = 4.0  # that one may take, as the server counts
SILENCE_S = 5.0  # of a transaction, as we count: a server that hangs does not count
CONNECTIONS = 16
SNAPSHOT = "SET TRANSACTION ISOLATION LEVEL REPEATABLE READ"
MIGRATING = 0x46504D4947  # of the advisory lock that one migration holds


class NoDriverError(ServerError):
    """psycopg is not installed: it is an extra."""

    def __init__(self) -> None:
        super().__init__(NO_DRIVER)


def engine(location: PostgresqlUrl, busy_s: float) -> Engine:
    """Connections that are kept, tried before they are used, and cut where the server answers no more."""
    made = _engine(
        location,
        {"lock_timeout": busy_s, "statement_timeout": STATEMENT_S},
        pool_size=CONNECTIONS,
        max_overflow=0,
        pool_timeout=busy_s,
    )
    watch = _SilenceWatch()
    event.listen(made, "checkout", watch.checkout)
    event.listen(made, "checkin", watch.checkin)
    event.listen(made, "engine_disposed", watch.disposed)
    return made


def patient_engine(location: PostgresqlUrl, *, changes: bool) -> Engine:
    """One connection for each use, for what takes its time: migrations, backups, and what other programs read."""
    limits = {"lock_timeout": 60.0} | ({} if changes else {"default_transaction_read_only": "on"})
    return _engine(location, limits, poolclass=NullPool)


def alone(tables: list[str]) -> str:
    """The statement by which a transaction has these tables to itself, but for who reads."""
    return f"LOCK TABLE {', '.join(tables)} IN SHARE ROW EXCLUSIVE MODE"


def number_on(connection: Connection, tables: Iterable[Table]) -> None:
    """Let what numbers the rows of these tables by itself go on after the largest; nothing on another database."""
    if connection.dialect.name != "postgresql":
        return
    for table in tables:
        (key,) = table.primary_key.columns
        sequence = connection.scalar(
            text("SELECT pg_get_serial_sequence(:table, :column)"), {"table": table.name, "column": key.name}
        )
        if sequence is not None and (largest := connection.scalar(select(func.max(key)))) is not None:
            connection.execute(text("SELECT setval(:sequence, :largest)"), {"sequence": sequence, "largest": largest})


def told(error: DBAPIError) -> StorageError | None:
    """What PostgreSQL's error is to whoever asked; None where it is an error of ours."""
    code = getattr(error.orig, "sqlstate", None)
    said = " ".join(str(error.orig).split())[:200]
    match code:
        case "53100" | "25006":  # disk full; read-only, a standby for one
            return StorageFullError(f"the database cannot be written: {said}")
        case "55P03" | "57014":  # a lock not had in time; a statement that took too long
            return StorageBusyError(f"the database is held by another program, or too slow: {said}")
        case None if error.connection_invalidated or isinstance(error, OperationalError):
            return StorageError(f"the database does not answer: {said}")
        case str() if code[:2] in ("08", "28", "3D", "53", "57", "58", "XX"):
            return StorageError(f"the database does not serve: {said}")
        case _:
            return None


def _engine(location: PostgresqlUrl, limits: dict[str, float | str], **pool: Any) -> Engine:
    url = make_url(location.url).set(drivername="postgresql+psycopg")
    given = url.query.get("options", "")
    told_ = [f"-c {name}={value if isinstance(value, str) else round(1e3 * value)}" for name, value in limits.items()]
    options = " ".join([given if isinstance(given, str) else " ".join(given), *told_]).strip()
    arguments = {
        "connect_timeout": CONNECT_S,
        "application_name": "fullpose",
        "options": options,
        "keepalives_idle": 5,
        "keepalives_interval": 2,
        "keepalives_count": 3,
        "tcp_user_timeout": round(1e3 * SILENCE_S),
    }
    try:
        made = create_engine(url, connect_args=arguments, json_serializer=_json, **pool)
    except ImportError:
        raise NoDriverError from None
    event.listen(made, "before_cursor_execute", _without_nul, retval=True)
    return made


def _json(value: Any) -> str:
    """As PostgreSQL takes it: a number that is none is null."""
    try:
        return json.dumps(value, allow_nan=False)
    except ValueError:
        return json.dumps(json.loads(json.dumps(value), parse_constant=lambda _: None))


def _without_nul(
    _connection: Any, _cursor: Any, statement: str, parameters: Any, _context: Any, _many: bool
) -> tuple[str, Any]:
    return statement, _shown(parameters)


def _shown(value: Any) -> Any:
    """Every NUL as the sign for it: what has one is found by nothing, and refused for nothing."""
    match value:
        case str():
            return value.replace(NUL, SHOWN)
        case dict():
            return {name: _shown(one) for name, one in value.items()}
        case list() | tuple():
            return type(value)(_shown(one) for one in value)
        case _:
            return value


class _SilenceWatch:
    """Cuts the connection of a transaction that hears nothing for too long, so that its thread goes on with an error.

    libpq waits for an answer without end, and a server that is stopped, not ended, still takes what is sent to it.
    """

    def __init__(self) -> None:
        self._changed = threading.Condition()
        self._used: dict[int, tuple[Any, float]] = {}  # by its record's id: a connection, and when it is cut
        self._thread: threading.Thread | None = None

    def checkout(self, connection: Any, record: Any, _fairy: Any) -> None:
        """One is taken into use: is it still one? Raises DisconnectionError, upon which the pool makes another."""
        with self._changed:
            self._used[id(record)] = (connection, time.monotonic() + SILENCE_S)
            if self._thread is None:
                self._thread = threading.Thread(target=self._watch, name="watches PostgreSQL", daemon=True)
                self._thread.start()
            self._changed.notify_all()
        try:
            connection.execute("SELECT 1")
            connection.rollback()
        except (connection.Error, OSError):
            self.checkin(connection, record)
            raise DisconnectionError from None

    def checkin(self, _connection: Any, record: Any) -> None:
        """It is used no more."""
        with self._changed:
            self._used.pop(id(record), None)

    def disposed(self, _engine: Engine) -> None:
        """There will be nothing to watch."""
        with self._changed:
            self._thread = None
            self._changed.notify_all()

    def _watch(self) -> None:
        me = threading.current_thread()
        with self._changed:
            while self._thread is me:
                now = time.monotonic()
                for key, (connection, until) in list(self._used.items()):
                    if until <= now:
                        del self._used[key]
                        _cut(connection)
                first = min((until for _, until in self._used.values()), default=None)
                self._changed.wait(None if first is None else max(first - now, 0.0))


def _cut(connection: Any) -> None:
    """Whoever waits for an answer on it is told that there is none."""
    with suppress(connection.Error, OSError), socket.socket(fileno=os.dup(connection.fileno())) as taken:
        taken.shutdown(socket.SHUT_RDWR)
