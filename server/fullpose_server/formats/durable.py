"""Onto the disk for good: what a crash or a power cut must not take back, in the order in which it was written."""

import os
from pathlib import Path


def sync(path: Path) -> None:
    """Wait until the file's content, or the folder's list of names, is on the disk. Raises OSError where it is not."""
    descriptor = os.open(path, os.O_RDONLY)
    try:
        os.fsync(descriptor)
    finally:
        os.close(descriptor)


def write(path: Path, data: bytes) -> None:
    """A file of these bytes, whole under its name or not at all. Raises OSError; then what was there before stays."""
    draft = path.with_name(f".{path.name}.{os.getpid()}")
    try:
        draft.write_bytes(data)
        rename(draft, path)
    except OSError:
        draft.unlink(missing_ok=True)
        raise


def rename(draft: Path, target: Path) -> None:
    """Give a finished file or folder its name: what has the name is whole, with all the files in it."""
    if draft.is_dir():
        for file in draft.iterdir():
            sync(file)
    sync(draft)
    draft.replace(target)
    sync(target.parent)
