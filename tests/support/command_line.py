"""The command line in this process, from its entry point on: what a new interpreter costs is paid by few tests."""

import contextlib
import io
import sys
import warnings
from dataclasses import dataclass
from pathlib import Path
from unittest import mock

from fullpose_server.cli import main


@dataclass(frozen=True)
class Done:
    """What a shell sees of a command that has ended."""

    returncode: int
    stdout: str
    stderr: str


def typed(*arguments: str | Path, given: str = "") -> Done:
    """A command that ends by itself, with `given` on its standard input; a warning is an error."""
    out, err = io.StringIO(), io.StringIO()
    with (
        mock.patch.object(sys, "argv", ["fullpose", *map(str, arguments)]),
        mock.patch.object(sys, "stdin", io.StringIO(given)),
        contextlib.redirect_stdout(out),
        contextlib.redirect_stderr(err),
        warnings.catch_warnings(),
    ):
        warnings.simplefilter("error")
        status = _status()
    return Done(status, out.getvalue(), err.getvalue())


def _status() -> int:
    try:
        main()
    except SystemExit as end:
        if isinstance(end.code, str):
            sys.stderr.write(f"{end.code}\n")
            return 1
        return end.code or 0
    return 0
