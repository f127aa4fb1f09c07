"""`fullpose backup` and `fullpose restore`: a server's data as one file, also while it serves, and put back."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from fullpose_server.cli._arguments import Config
from fullpose_server.cli._exit import fail
from fullpose_server.cli._people import DataDir, day
from fullpose_server.cli._progress import progress_bar

if TYPE_CHECKING:
    from fullpose_server.store.backup import Manifest


def register(app: typer.Typer) -> None:
    """Add the commands."""
    app.command("backup", help="Write a server's data into one file; it may serve meanwhile.")(backup)
    app.command("restore", help="Make a data folder of a backup, or only check one.")(restore)


def backup(
    file: Annotated[Path, typer.Argument(metavar="FILE", help="The backup to write, a tar.")],
    data_dir: DataDir = None,
    config: Config = None,
) -> None:
    """Write a backup, whole or not at all."""
    from fullpose_server.cli._configuration import configured
    from fullpose_server.formats.output_file import check_writable
    from fullpose_server.store.backup import make_backup

    check_writable(file)
    settings = configured(data_dir=data_dir, config=config).settings
    with progress_bar("backup") as progress:
        typer.echo(_told(make_backup(settings.data_dir, file, progress, settings.database)))


def restore(
    file: Annotated[Path, typer.Argument(metavar="FILE", help="A backup.")],
    data_dir: DataDir = None,
    check: Annotated[bool, typer.Option("--check", help="Read all of it, and write nothing.")] = False,
    config: Config = None,
) -> None:
    """Make a data folder, which must be empty or not there yet; a server starts on it as ever."""
    from fullpose_server.cli._configuration import configured
    from fullpose_server.location import PostgresqlUrl
    from fullpose_server.store.restore import check_backup, restore_backup

    if check and data_dir is not None:
        fail("--check and --data-dir: expected one of them, nothing is written by --check")
    with progress_bar("restore") as progress:
        if check:
            done = check_backup(file, progress)
        else:
            settings = configured(data_dir=data_dir, config=config).settings
            rows = settings.database if isinstance(settings.database, PostgresqlUrl) else None
            done = restore_backup(file, settings.data_dir, progress, rows)
    typer.echo(_told(done))


def _told(manifest: "Manifest") -> str:
    made = f"made {day(manifest.made)} UTC by Fullpose {manifest.version}, database revision {manifest.revision}"
    return f"{len(manifest.files)} files, {manifest.bytes / 1e6:.1f} MB, {made}"
