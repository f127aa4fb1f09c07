"""`fullpose audit`: prove that nothing in a server's audit was changed, and list it."""

import json
from datetime import UTC, datetime
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from fullpose_server.cli._arguments import Config
from fullpose_server.cli._exit import fail

if TYPE_CHECKING:
    from fullpose_server.location import Location

DataDir = Annotated[Path | None, typer.Option(help="Where the server keeps its data.")]


def register(app: typer.Typer) -> None:
    """Add the commands."""
    group = typer.Typer(no_args_is_help=True, rich_markup_mode=None, help="Who did what: a server's audit.")
    group.command("verify", help="Prove that no line was changed, taken out, put in or moved.")(verify)
    group.command("list", help="Print the lines as JSON, one each, the oldest first.")(lines)
    app.add_typer(group, name="audit")


def verify(
    data_dir: DataDir = None,
    config: Config = None,
    expect: Annotated[
        str | None, typer.Option(metavar="HASH", help="A hash that was kept elsewhere: its line must still be there.")
    ] = None,
) -> None:
    """Read the database, also while the server serves, and write nothing. Exit 2 where a line does not fit."""
    from fullpose_server.store import hash_chain
    from fullpose_server.store.audit import read_rows
    from fullpose_server.store.reading import reading

    kept = None if expect is None else expect.strip().lower()
    if kept is not None and (len(kept) != 64 or set(kept) - set("0123456789abcdef")):
        fail(f"--expect {expect}: expected a sha-256, 64 hexadecimal digits")
    path = _database(data_dir, config)
    with reading(path) as session:
        found = hash_chain.verify(read_rows(session), kept)
    if found.broken is not None:
        good = f"the {found.rows} before it are as they were written" if found.rows else "it is the first"
        fail(f"{path}: line {found.broken} of the audit: {found.why} ({good})")
    if found.why is not None:
        fail(f"{path}: {found.why} ({found.rows} lines fit each other)")
    if found.first_at is None or found.last_at is None:
        typer.echo("0 lines: nothing has been done yet")
        return
    typer.echo(f"{found.rows} lines, {_time(found.first_at)} to {_time(found.last_at)}: each as it was written")
    if kept is not None:
        typer.echo(f"among them the one with the hash {kept}")
    typer.echo(f"newest hash {found.head}")
    if kept is None:
        typer.echo("That the newest lines were not cut off is shown by a hash kept elsewhere: --expect HASH")


def lines(
    data_dir: DataDir = None,
    config: Config = None,
    rig: Annotated[str | None, typer.Option(help="Those of this rig alone.")] = None,
) -> None:
    """Print every line, with its hash, and with all that the hash is of."""
    from fullpose_server.store.audit import read_rows
    from fullpose_server.store.reading import reading

    with reading(_database(data_dir, config)) as session:
        for row in read_rows(session, rig=rig):
            typer.echo(json.dumps({**row, "time": _time(row["at"])}))


def _database(data_dir: Path | None, config: Path | None) -> "Location":
    from fullpose_server.cli._configuration import configured

    return configured(data_dir=data_dir, config=config).settings.database


def _time(seconds: float) -> str:
    return datetime.fromtimestamp(seconds, UTC).isoformat(timespec="milliseconds").replace("+00:00", "Z")
