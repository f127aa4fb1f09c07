"""A backup looked at, and a data folder made of it: `fullpose restore`. See `backup` for what is in one."""

import hashlib
import json
import shutil
import tarfile
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager, nullcontext
from pathlib import Path, PurePosixPath
from typing import Any

from sqlalchemy.exc import DBAPIError
from sqlalchemy.orm import Session

from fullpose_server.errors import FileError
from fullpose_server.formats import durable
from fullpose_server.location import DATABASE, PostgresqlUrl
from fullpose_server.store import postgresql
from fullpose_server.store.backup import (
    CHUNK,
    FOLDERS,
    FORMAT,
    MANIFEST,
    RIGS,
    SECRET,
    BackupError,
    Manifest,
    Member,
    Progress,
)
from fullpose_server.store.copying import check_empty, copy_rows
from fullpose_server.store.database import HEAD, Database, UnreachableDatabaseError
from fullpose_server.version import VERSION

_MOST = 64 << 20  # [bytes] of a manifest


def check_backup(file: Path, progress: Progress | None = None) -> Manifest:
    """Read all of it. Raises `FileError` for the first file that is not what the manifest says, `BackupError`."""
    return _walk(file, None, progress)


def restore_backup(
    file: Path, data_dir: Path, progress: Progress | None = None, database: PostgresqlUrl | None = None
) -> Manifest:
    """Make a data folder of it, which must not be there yet (or be empty): whole or not at all.

    The rows go into `database`, a PostgreSQL without any, where one is named, and else stay in the folder's own file.
    Raises `BackupError`, `FileError`, `NotEmptyError`, `StorageError`, OSError.
    """
    if data_dir.exists() and (not data_dir.is_dir() or any(data_dir.iterdir())):
        raise BackupError(f"{data_dir}: expected a folder that is empty or not there, move this one away first")
    data_dir.parent.mkdir(parents=True, exist_ok=True)
    draft = Path(tempfile.mkdtemp(prefix=f".{data_dir.name}.", dir=data_dir.parent))
    try:
        with _rows_in(database) if database is not None else nullcontext() as rows:
            manifest = _walk(file, draft, progress)
            if rows is not None:
                _move_rows(draft / DATABASE, rows)
            _put(draft, data_dir)
    except BaseException:
        if not draft.exists():  # it is in its place already, and its rows are not
            draft = data_dir
        shutil.rmtree(draft, ignore_errors=True)
        raise
    return manifest


def _put(draft: Path, data_dir: Path) -> None:
    if data_dir.is_dir():
        data_dir.rmdir()
    draft.chmod(0o755)
    draft.replace(data_dir)
    durable.sync(data_dir.parent)


@contextmanager
def _rows_in(location: PostgresqlUrl) -> Iterator[Session]:
    """A transaction on an empty database. Raises `NotEmptyError`, `StorageError`."""
    Database(location).close()  # brings it up
    engine = postgresql.patient_engine(location, changes=True)
    try:
        with Session(engine) as session, session.begin():
            check_empty(session, str(location))
            yield session
    except DBAPIError as error:
        raise UnreachableDatabaseError(location, error) from error
    finally:
        engine.dispose()


def _move_rows(file: Path, target: Session) -> None:
    """From the backup's file, which is not needed any more then."""
    source = Database(file)  # brings up what an earlier version wrote
    try:
        with source.begin_snapshot() as session:
            copy_rows(session, target)
    finally:
        source.close()
    file.unlink()


def _opened(file: Path) -> tarfile.TarFile:
    try:
        return tarfile.open(file, "r:")
    except FileNotFoundError:
        raise FileError(str(file), "a backup, there is no such file") from None
    except tarfile.TarError:
        raise FileError(str(file), "a backup as `fullpose backup` makes them, this is no tar") from None


def _manifest(file: Path, archive: tarfile.TarFile) -> Manifest:
    try:
        entry = archive.next()
        stream = None if entry is None or entry.name != MANIFEST or entry.size > _MOST else archive.extractfile(entry)
        told: dict[str, Any] = {} if stream is None else json.loads(stream.read())
        manifest = Manifest(
            float(told["made"]), str(told["version"]), str(told["revision"]), [Member(**each) for each in told["files"]]
        )
        format_ = int(told["format"])
    except (KeyError, TypeError, ValueError, tarfile.TarError):
        raise FileError(str(file), f"a backup as `fullpose backup` makes them, with {MANIFEST} first") from None
    if format_ > FORMAT or manifest.revision > HEAD:
        raise BackupError(f"{file} was made by Fullpose {manifest.version}, which is newer than this one, {VERSION}")
    return manifest


def _walk(file: Path, into: Path | None, progress: Progress | None) -> Manifest:
    """Compare every file with the manifest, and write it into the folder `into`, where there is one."""
    with _opened(file) as archive:
        manifest = _manifest(file, archive)
        done = 0
        for member in manifest.files:
            entry = _next(file, archive)
            if entry is None or entry.name != member.name or not entry.isreg() or entry.size != member.size:
                raise FileError(str(file), f"{member.name} next, as its manifest says: it is damaged or was changed")
            _take(file, archive, entry, member, into)
            done += member.size
            if progress is not None:
                progress(done, manifest.bytes)
        if _next(file, archive) is not None:
            raise FileError(str(file), "no more files than its manifest says: it was changed")
    return manifest


def _next(file: Path, archive: tarfile.TarFile) -> tarfile.TarInfo | None:
    try:
        return archive.next()
    except tarfile.TarError:
        raise FileError(str(file), "a whole backup: it is damaged or was cut off") from None


def _take(file: Path, archive: tarfile.TarFile, entry: tarfile.TarInfo, member: Member, into: Path | None) -> None:
    stream = archive.extractfile(entry)
    parts = PurePosixPath(member.name).parts
    allowed = member.name in SECRET or (len(parts) > 1 and parts[0] in (*FOLDERS, RIGS))
    if stream is None or not allowed or ".." in parts or "\\" in member.name:
        raise FileError(str(file), f"files of a data folder, not {member.name!r}")
    digest = hashlib.sha256()
    target = None
    if into is not None:
        path = into / member.name
        path.parent.mkdir(parents=True, exist_ok=True)
        target = path.open("xb")
    try:
        while part := stream.read(CHUNK):
            digest.update(part)
            if target is not None:
                target.write(part)
    except tarfile.TarError:
        raise FileError(str(file), f"all of {member.name}: it was cut off") from None
    finally:
        if target is not None:
            target.close()
            path.chmod(0o600 if member.name in SECRET else 0o644)
            durable.sync(path)
    if digest.hexdigest() != member.sha256:
        raise FileError(str(file), f"{member.name} as its manifest says: it is damaged or was changed")
