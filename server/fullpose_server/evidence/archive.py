"""The zip of a bundle: written the same for the same members, and read only where every byte is as it is written here.

Nothing in it is compressed: the record is already, and what is stored as it is cannot unpack to more than it takes. So
there is one way to write given members, and a byte that is not of that way is found, whatever it means to others.
"""

import hashlib
import re
import struct
import zipfile
from collections.abc import Iterator
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from types import TracebackType
from typing import IO

from fullpose_server.evidence.errors import BundleError

MOST_MEMBERS = 64
CHUNK = 1 << 20
_DATE = (1980, 1, 1, 0, 0, 0)  # the first there is: when it was signed is in the signature
_NAME = re.compile(r"[a-z0-9_]+(?:\.[a-z0-9]+)*(?:/[a-z0-9_]+(?:\.[a-z0-9]+)*)?")
_LOCAL = 30  # [bytes] of a member's own header before its name
_END = struct.Struct("<4s4H2LH")
_ORDINARY = 0o100644 << 16


@dataclass(frozen=True)
class Member:
    """A file of the archive."""

    size: int
    sha256: str


class ArchiveWriter:
    """Adds members in order; `members` tells what they were."""

    def __init__(self, path: Path) -> None:
        self._zip = zipfile.ZipFile(path, "w", zipfile.ZIP_STORED)
        self.members: dict[str, Member] = {}

    def __enter__(self) -> "ArchiveWriter":
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        if kind is None:
            self._zip.close()
            return
        with suppress(OSError, ValueError):  # it is of no use any more
            self._zip.close()

    def add_file(self, name: str, path: Path) -> None:
        """Add a file's content as it is now."""
        with path.open("rb") as source:
            self._add(name, path.stat().st_size, _chunks(source))

    def add(self, name: str, content: bytes) -> None:
        """Add content."""
        self._add(name, len(content), iter((content,)))

    def _add(self, name: str, size: int, chunks: Iterator[bytes]) -> None:
        info = _info(name)
        info.file_size = size  # for large ones are laid out in another way
        digest, length = hashlib.sha256(), 0
        with self._zip.open(info, "w") as member:
            for chunk in chunks:
                digest.update(chunk)
                length += len(chunk)
                member.write(chunk)
        self.members[name] = Member(length, digest.hexdigest())


class ArchiveReader:
    """The members of an archive that is laid out as `ArchiveWriter` does. Raises `BundleError` for any other."""

    def __init__(self, path: Path) -> None:
        self._path = path
        try:
            self._file = path.open("rb")
            try:
                self._zip = zipfile.ZipFile(self._file)
                self.names = self._checked()
            except BaseException:
                self._file.close()
                raise
        except OSError as error:
            raise BundleError(path, f"cannot be read: {error.strerror}") from None
        except (zipfile.BadZipFile, NotImplementedError, ValueError, struct.error, RuntimeError) as error:
            raise BundleError(path, f"not a bundle: {error}") from None

    def __enter__(self) -> "ArchiveReader":
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._zip.close()
        self._file.close()

    def member(self, name: str, copy: Path | None = None) -> Member:
        """What a member is, read to its end; and a copy of it, where one is wanted. Raises `BundleError`."""
        digest, size = hashlib.sha256(), 0
        with open(copy, "wb") if copy is not None else _Nowhere() as target:  # noqa: PTH123
            for chunk in self._content(name):
                digest.update(chunk)
                size += len(chunk)
                target.write(chunk)
        return Member(size, digest.hexdigest())

    def read(self, name: str, most: int) -> bytes:
        """A member's content. Raises `BundleError`, also where it has more than so many bytes."""
        if name not in self.names:
            raise BundleError(self._path, f"{name} is missing")
        if self._zip.getinfo(name).file_size > most:
            raise BundleError(self._path, f"{name} has more than {most} bytes")
        return b"".join(self._content(name))

    def _content(self, name: str) -> Iterator[bytes]:
        try:
            with self._zip.open(name) as member:
                yield from _chunks(member)
        except (zipfile.BadZipFile, EOFError, OSError, NotImplementedError, RuntimeError) as error:
            raise BundleError(self._path, f"{name}: {error}") from None

    def _checked(self) -> tuple[str, ...]:
        """The names. Raises `BundleError` where anything is not as it is written."""
        infos = self._zip.infolist()
        names = tuple(info.filename for info in infos)
        if len(infos) > MOST_MEMBERS:
            raise BundleError(self._path, f"{len(infos)} files: expected at most {MOST_MEMBERS}")
        if len(set(names)) != len(names):
            raise BundleError(self._path, "two files of one name")
        at = 0
        for info in infos:
            name = info.filename
            if _NAME.fullmatch(name) is None or info.orig_filename != name:
                raise BundleError(self._path, f"{name!r}: not the name of a file of a bundle")
            if info.compress_type != zipfile.ZIP_STORED or info.compress_size != info.file_size:
                raise BundleError(self._path, f"{name} is compressed: nothing in a bundle is")
            at = self._check_member(info, at)
        self._check_end(infos, at)
        return names

    def _check_member(self, info: zipfile.ZipInfo, at: int) -> int:
        """Compare a member's headers; returns where the next begins."""
        made = _info(info.filename)
        made.CRC, made.file_size, made.compress_size = info.CRC, info.file_size, info.compress_size
        large = info.file_size * 1.05 > zipfile.ZIP64_LIMIT
        header = made.FileHeader(zip64=large)
        self._file.seek(at)
        told = ("flag_bits", "date_time", "external_attr", "internal_attr", "create_system", "volume", "comment")
        same = all(getattr(info, name) == getattr(made, name) for name in told)
        versions = (info.create_version, info.extract_version) == (made.create_version, made.extract_version)
        if info.header_offset != at or self._file.read(len(header)) != header or not (same and versions):
            raise BundleError(self._path, f"{info.filename}: its header is not as it was written")
        if not large and info.extra:
            raise BundleError(self._path, f"{info.filename}: something was added to its header")
        return at + len(header) + info.file_size

    def _check_end(self, infos: list[zipfile.ZipInfo], at: int) -> None:
        """Compare what follows the members: their list, and nothing else."""
        length = self._file.seek(0, 2)
        listed = sum(46 + len(info.filename) for info in infos)
        if self._zip.comment:
            raise BundleError(self._path, "something was added to its end")
        if length > zipfile.ZIP64_LIMIT:
            return  # laid out in another way: what is in it is compared all the same
        end = _END.pack(b"PK\x05\x06", 0, 0, len(infos), len(infos), listed, at, 0)
        self._file.seek(max(0, length - len(end)))
        if self._file.read() != end or length != at + listed + len(end):
            raise BundleError(self._path, "its end is not as it was written")


class _Nowhere:
    """Where what is not kept is written."""

    def __enter__(self) -> "_Nowhere":
        return self

    def __exit__(self, *_: object) -> None:
        pass

    def write(self, data: bytes) -> int:
        return len(data)


def _info(name: str) -> zipfile.ZipInfo:
    info = zipfile.ZipInfo(name, _DATE)
    info.create_system = 3
    info.external_attr = _ORDINARY
    info.compress_type = zipfile.ZIP_STORED
    return info


def _chunks(source: IO[bytes]) -> Iterator[bytes]:
    while chunk := source.read(CHUNK):
        yield chunk
