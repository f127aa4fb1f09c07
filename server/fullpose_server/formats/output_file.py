"""Files that are written: whole or not at all, and never over an input or another output."""

import os
import stat
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path

from fullpose_server.errors import FileError
from fullpose_server.formats import durable


@contextmanager
def replacing(path: Path) -> Iterator[Path]:
    """A path beside `path` to write to; it takes the place of `path` at the end, and is removed by an exception.

    Links are followed: what they lead to is replaced. Raises `FileError` as `check_writable`.
    """
    with durable.replacing(_target(path)) as draft:
        yield draft


def check_writable(path: Path) -> None:
    """Raise `FileError` where `path` cannot become a file, before work is done for it."""
    target = _target(path)
    folder = target.parent
    if not folder.exists():
        raise FileError(str(path), f"a place to write, there is no folder {folder}")
    if not folder.is_dir() or not os.access(folder, os.W_OK | os.X_OK):
        raise FileError(str(path), f"a place to write, {folder} is not one")


def check_apart(outputs: Mapping[str, Path | None], inputs: Mapping[str, Path]) -> None:
    """Raise `FileError` where two outputs are one file, or an output is an input: it would be lost. None is no file."""
    taken = dict(inputs)
    for name, path in outputs.items():
        if path is None:
            continue
        other = next((other for other, there in taken.items() if _same(path, there)), None)
        if other is not None:
            raise FileError(str(path), f"another file for {name}, this one is {other}")
        taken[name] = path


def _target(path: Path) -> Path:
    """The file that is or will be at `path`, links followed. Raises `FileError` for what is there and no plain file.

    Not written to directly: a file that appears whole or not at all has to be put in place of another.
    """
    if str(path) == "-":
        raise FileError("-", "the name of a file, standard output is not written to")
    target = Path(os.path.realpath(path))
    try:
        mode = path.stat().st_mode
    except OSError:
        if target.is_symlink():
            raise FileError(str(path), "a file to write, this is a link that leads nowhere") from None
        return target
    if stat.S_ISDIR(mode):
        raise FileError(str(path), "a file to write, this is a folder")
    if not stat.S_ISREG(mode):
        raise FileError(str(path), "a plain file to write, this is a device, pipe or socket")
    return target


def _same(one: Path, other: Path) -> bool:
    try:
        return one.samefile(other)
    except OSError:  # one of them is still to be made
        return os.path.realpath(one) == os.path.realpath(other)


def write_text(path: Path, text: str) -> None:
    """Write a text file, whole or not at all."""
    with replacing(path) as draft:
        draft.write_text(text, encoding="utf-8")
