"""Onto the disk for good: what a crash or a power cut must not take back, in the order in which it was written."""

import os
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from uuid import uuid4


def sync(path: Path) -> None:
    """Wait until the file's content, or the folder's list of names, is on the disk. Raises OSError where it is not."""
    descriptor = os.open(path, os.O_RDONLY)
    try:
        os.fsync(descriptor)
    finally:
        os.close(descriptor)


@contextmanager
def replacing(target: Path) -> Iterator[Path]:
    """A path beside `target` to write to: it takes the place of `target` at the end, whole, as a file like any other.

    By an exception it is removed, and what was there before stays. Raises OSError.
    """
    draft = target.with_name(f".{target.name}.{uuid4().hex}")
    draft.touch(exist_ok=False)
    try:
        yield draft
        rename(draft, target)
    except BaseException:
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
