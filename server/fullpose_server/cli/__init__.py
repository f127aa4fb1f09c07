"""The command line (DESIGN: a contract that other programs rely on).

Each module here is one command and has `register(app)`. A module imports what it needs inside its command, so that
`--help` and `solve` do not pay for the server.
"""

import importlib
import pkgutil
import sys

import typer

from fullpose.errors import SolverError
from fullpose_server.cli._exit import BAD_INPUT, fail
from fullpose_server.errors import FileError, ServerError

ORDER = (
    *(
        "demo",
        "serve",
        "solve",
        "inspect",
        "remedy",
        "compare",
        "rigs",
        "export",
        "evidence",
        "audit",
        "backup",
        "restore",
    ),
    *("user", "token", "doctor", "config"),
)


def build() -> typer.Typer:
    """The app with every command of this folder."""
    app = typer.Typer(
        name="fullpose",
        help="Fly attitude trajectories on four-axis flight motion simulators.",
        no_args_is_help=True,
        add_completion=False,
        rich_markup_mode=None,
        pretty_exceptions_enable=False,
        context_settings={"help_option_names": ["-h", "--help"], "max_content_width": 100},
    )
    app.callback()(_root)
    found = {module.name for module in pkgutil.iter_modules(__path__) if not module.name.startswith("_")}
    for name in sorted(found, key=lambda name: (ORDER.index(name) if name in ORDER else len(ORDER), name)):
        importlib.import_module(f"{__name__}.{name}").register(app)
    return app


def main() -> None:
    """Entry point. Exit status: 0 done, 2 bad input, 3 not feasible within the limits."""
    try:
        build()()
    except FileError as error:
        fail(error.for_command_line)
    except (ServerError, SolverError) as error:
        fail(str(error))
    except KeyboardInterrupt:
        sys.exit(130)  # as a shell says it
    except BrokenPipeError:  # the reader of a pipe has gone: nothing to say to anybody
        sys.stderr.close()
        sys.exit(0)
    except OSError as error:
        fail(f"{error.filename}: {error.strerror}" if error.filename else str(error), BAD_INPUT)


def _version(value: bool) -> None:
    if value:
        from fullpose_server.version import VERSION

        typer.echo(VERSION)
        raise typer.Exit


def _root(
    version: bool = typer.Option(False, "--version", callback=_version, is_eager=True, help="Print the version."),
) -> None:
    """Fly attitude trajectories on four-axis flight motion simulators."""
