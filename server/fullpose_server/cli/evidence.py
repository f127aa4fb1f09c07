"""`fullpose evidence RUN`: a run as one signed file; `verify` it anywhere; the `key` that it is signed with."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer
from typer.core import TyperGroup

from fullpose_server.cli._arguments import Config

if TYPE_CHECKING:
    from fullpose_server.settings import Settings

MAKE = "run"
DataDir = Annotated[Path | None, typer.Option(help="Where the server keeps its data.")]


class _OfRun(TyperGroup):
    """What is no command of the group is the run that evidence is made of: `fullpose evidence RUN --out F.zip`."""

    def parse_args(self, ctx: Any, args: list[str]) -> list[str]:
        """Put the command's name before its arguments where it is left out."""
        helps = {"--help", "-h"}
        if args and args[0] not in self.commands and args[0] not in helps:
            args = [MAKE, *args]
        return super().parse_args(ctx, args)


def register(app: typer.Typer) -> None:
    """Add the commands."""
    group = typer.Typer(
        cls=_OfRun, no_args_is_help=True, rich_markup_mode=None, help="A run as one signed file (RUN --out F.zip)."
    )
    group.command(MAKE, help="Write the evidence of RUN. The word `run` may be left out.")(make)
    group.command("verify", help="Verify a bundle: every byte, its signature, plan, flight, rig and audit.")(verify)
    group.command("key", help="Print the public key of this server, by which others verify.")(key)
    app.add_typer(group, name="evidence")


def make(
    run: Annotated[str, typer.Argument(metavar="RUN", help="Id of a run, or `latest`.")],
    out: Annotated[Path | None, typer.Option(help="File to write. Default: RUN.zip.")] = None,
    data_dir: DataDir = None,
    config: Config = None,
) -> None:
    """Read the data folder, also while the server serves, and write one file, whole or not at all."""
    from fullpose_server.evidence.bundle import make_bundle
    from fullpose_server.formats.output_file import check_writable

    settings = _settings(data_dir, config)
    folder = settings.data_dir
    name = _latest(folder) if run == "latest" else run
    target = out or Path(f"{name}.zip")
    check_writable(target)
    manifest = make_bundle(folder, name, target, settings.database)
    typer.echo(str(target))
    typer.echo(manifest["outcome"]["sentence"])
    for part, why in sorted(manifest["missing"].items()):
        typer.echo(f"without the {part}: {why}")


def verify(
    file: Annotated[Path, typer.Argument(metavar="FILE", help="A bundle.")],
    key: Annotated[
        str | None, typer.Option(metavar="PUBLICKEY", help="The key it has to be signed with, or a file with it.")
    ] = None,
) -> None:
    """Needs nothing but the file. Exit 2 where anything in it is not as it was signed."""
    from fullpose_server.evidence.signing import read_public_key
    from fullpose_server.evidence.verification import verify_bundle

    found = verify_bundle(file, None if key is None else read_public_key(key))
    _print(f"{file}: evidence of run {found.run} on rig {found.rig}")
    _print(found.sentence)
    _print(f"{found.files} files as they were signed; {', '.join(found.fits)} fit")
    for part, why in sorted(found.missing.items()):
        _print(f"without the {part}: {why}")
    _print(f"signed at {found.signed_at} with the key {found.public_key}")
    if found.trusted:
        typer.echo("which is the key that was asked for")
    else:
        typer.echo(
            "Whose key that is, is the bundle's own word: compare it with what `fullpose evidence key` prints at"
        )
        typer.echo("the server, or name it with --key PUBLICKEY")


def key(data_dir: DataDir = None, config: Config = None) -> None:
    """Make the key where there is none."""
    from fullpose_server.cli._exit import fail
    from fullpose_server.evidence.signing import public_key, signing_key

    folder = _settings(data_dir, config).data_dir
    if not folder.is_dir():
        fail(f"{folder}: there is no such data folder, name another --data-dir")
    typer.echo(public_key(signing_key(folder)))


def _print(line: str) -> None:
    """What anybody may have written, as one line that does nothing else to the terminal."""
    typer.echo("".join(letter if letter.isprintable() else "?" for letter in line))


def _settings(data_dir: Path | None, config: Path | None) -> "Settings":
    from fullpose_server.cli._configuration import configured

    return configured(data_dir=data_dir, config=config).settings


def _latest(folder: Path) -> str:
    from fullpose_server.cli._exit import fail

    found = sorted((folder / "runs").glob("*.mcap"))
    if not found:
        fail(f"no runs are recorded in {folder / 'runs'}: name another --data-dir")
    return found[-1].stem
