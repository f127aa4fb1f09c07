"""A data folder as one file, made while a server works on it (`fullpose backup`); `restore` puts it back.

A tar: manifest.json first (format, version, database revision, every file with its size and sha-256), then the files.
The database is an SQLite file of one moment: SQLite's own online backup, or the rows of a PostgreSQL written into one,
so that a backup of either is restored into either. The other files are linked at the beginning into a folder
beside them: what is removed or replaced meanwhile is in the backup as it was, and what is made meanwhile is at most
more than the database knows. A record that is being written is copied as far as it was written. What belongs to a
running server (locks, sockets, uploads) and what it put aside (quarantine) stays.
"""

import hashlib
import io
import json
import os
import shutil
import sqlite3
import tarfile
import tempfile
import time
from collections.abc import Callable, Iterator
from contextlib import closing
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import IO

from fullpose_server.errors import ServerError
from fullpose_server.formats import durable
from fullpose_server.location import DATABASE, EVIDENCE_KEY, Location
from fullpose_server.store.belonging import check
from fullpose_server.store.copying import copy_rows
from fullpose_server.store.database import HEAD, Database
from fullpose_server.store.reading import reading
from fullpose_server.store.readonly import readonly
from fullpose_server.version import VERSION

FORMAT = 1
MANIFEST = "manifest.json"
FOLDERS = ("trajectories", "plans", "comparisons", "runs", "profiles")
RIGS = "rigs"  # of these the files, not the folders of their processes
SECRET = (DATABASE, EVIDENCE_KEY)  # at the top, readable by their owner alone
SCRATCH = ".backup-"
CHUNK = 1 << 20
Progress = Callable[[int, int], None]


class BackupError(ServerError):
    """A backup that cannot be made, or is none."""


@dataclass(frozen=True)
class Member:
    """A file of a backup."""

    name: str
    size: int
    sha256: str


@dataclass(frozen=True)
class Manifest:
    """What a backup says of itself."""

    made: float  # [s since 1970]
    version: str
    revision: str  # of the database
    files: list[Member]

    @property
    def bytes(self) -> int:
        """Of all files together."""
        return sum(each.size for each in self.files)


def make_backup(
    data_dir: Path, target: Path, progress: Progress | None = None, database: Location | None = None
) -> Manifest:
    """Write the backup of a data folder, whole or not at all; its rows are in `database`, by default its own file.

    Raises `BackupError`, `ServerError` for a database that cannot be read, OSError.
    """
    rows = database or data_dir / DATABASE
    if not (rows.is_file() if isinstance(rows, Path) else data_dir.is_dir()):
        raise BackupError(f"{data_dir}: expected a data folder, there is no {DATABASE} in it")
    _forget_cut_off(data_dir)
    with tempfile.TemporaryDirectory(prefix=SCRATCH, dir=data_dir) as scratch:
        held = Path(scratch)
        copy = held / DATABASE
        revision = _copied(rows, copy) if isinstance(rows, Path) else _written(data_dir, rows, copy)
        names = [DATABASE, *(name for name in _names(data_dir) if _held(data_dir / name, held / name))]
        manifest = Manifest(time.time(), VERSION, revision, [_measured(name, held / name) for name in names])
        with durable.replacing(target) as draft, tarfile.open(draft, "w") as archive:
            draft.chmod(0o600)  # hashes of passwords are in it
            document = json.dumps({"format": FORMAT} | asdict(manifest), indent=1).encode()
            _add(archive, MANIFEST, io.BytesIO(document), len(document))
            done = 0
            for member in manifest.files:
                with (held / member.name).open("rb") as stream:
                    _add(archive, member.name, stream, member.size)
                done += member.size
                if progress is not None:
                    progress(done, manifest.bytes)
    return manifest


def _written(data_dir: Path, database: Location, target: Path) -> str:
    """The rows of a PostgreSQL as an SQLite file, of one moment: its revision. Raises `ServerError`."""
    made = Database(target)
    try:
        with reading(database) as source:
            check(source, database, data_dir)
            with made.begin() as session:
                copy_rows(source, session)
    finally:
        made.close()
    with closing(sqlite3.connect(target)) as copy:
        copy.execute("PRAGMA journal_mode=DELETE")
    return HEAD


def _copied(database: Path, target: Path) -> str:
    """A copy of one moment, also of a database that is being written: its revision. Raises `BackupError`."""
    try:
        with closing(sqlite3.connect(readonly(database), uri=True)) as source, closing(sqlite3.connect(target)) as copy:
            source.backup(copy)
            copy.execute("PRAGMA journal_mode=DELETE")  # one file, without a log beside it
            row = copy.execute("SELECT version_num FROM alembic_version").fetchone()
            found = copy.execute("PRAGMA quick_check(1)").fetchone()
    except sqlite3.Error as error:
        raise BackupError(f"{database}: cannot be copied: {error}") from None
    if found != ("ok",):
        raise BackupError(f"{database}: it is damaged: {found[0]}")
    return str(row[0])


def _names(data_dir: Path) -> Iterator[str]:
    """Of the files beside the database, as paths in the data folder."""
    yield from (name for name in SECRET[1:] if (data_dir / name).is_file())
    found = [path for folder in FOLDERS for path in sorted((data_dir / folder).rglob("*"))]
    for path in [*found, *sorted((data_dir / RIGS).glob("*"))]:
        parts = path.relative_to(data_dir).parts
        if not any(part.startswith(".") for part in parts) and path.is_file() and not path.is_symlink():
            yield "/".join(parts)


def _held(path: Path, link: Path) -> bool:
    """Keep a file as it is now, whatever becomes of its name; False where it has gone already."""
    link.parent.mkdir(parents=True, exist_ok=True)
    try:
        os.link(path, link)
    except FileNotFoundError:
        return False
    return True


def _measured(name: str, path: Path) -> Member:
    with path.open("rb") as stream:
        size, digest = _digest(stream, path.stat().st_size)
    return Member(name, size, digest)


def _forget_cut_off(data_dir: Path) -> None:
    """Remove what a backup left that was killed a day ago or longer."""
    for left in data_dir.glob(f"{SCRATCH}*"):
        if time.time() - left.stat().st_mtime > 86400.0:
            shutil.rmtree(left, ignore_errors=True)


def _digest(stream: IO[bytes], size: int) -> tuple[int, str]:
    """(bytes read, sha-256) of at most `size` bytes: of what is being written, no more than is measured."""
    digest, done = hashlib.sha256(), 0
    while done < size and (part := stream.read(min(CHUNK, size - done))):
        digest.update(part)
        done += len(part)
    return done, digest.hexdigest()


def _add(archive: tarfile.TarFile, name: str, stream: IO[bytes], size: int) -> None:
    entry = tarfile.TarInfo(name)
    entry.size, entry.mtime, entry.mode = size, int(time.time()), 0o600
    archive.addfile(entry, stream)
