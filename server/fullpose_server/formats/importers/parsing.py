"""A library's parse of a file from outside: whatever it makes of damaged bytes is one error, and nothing is printed."""

import contextlib
import gc
import io
import logging
import sys
import traceback
import warnings
from collections.abc import Iterator

from fullpose_server.errors import FileError


@contextlib.contextmanager
def parsing(file: str, about: str) -> Iterator[None]:
    """Raise `FileError` for whatever a library raises in it; `about`: the kind of file, as a person calls it.

    `MemoryError` goes on: it is the reading process that has too little, not the file that is damaged.
    """
    with _silence():
        try:
            yield
        except (FileError, MemoryError):
            raise
        except Exception as error:  # noqa: BLE001 - each library has errors of its own for bytes that it did not expect
            told = f"{type(error).__name__}: {str(error).split(chr(10))[0][:160]}"
            _close(error)
            raise FileError(file, f"a whole {about} ({told})") from None


@contextlib.contextmanager
def _silence() -> Iterator[None]:
    """Nothing is printed, warned of or logged: what a person is to know of the file is in what is read of it."""
    said, logged = io.StringIO(), logging.root.manager.disable
    logging.disable()
    try:
        with contextlib.redirect_stdout(said), contextlib.redirect_stderr(said), warnings.catch_warnings():
            warnings.simplefilter("ignore")
            yield
    finally:
        logging.disable(logged)


def _close(error: Exception) -> None:
    """Close what the library had opened, here and in silence: a reader that was made by half complains of it."""
    hook = sys.unraisablehook
    sys.unraisablehook = lambda _unraisable: None
    try:
        traceback.clear_frames(error.__traceback__)
        error.__traceback__ = None
        gc.collect()
    finally:
        sys.unraisablehook = hook
