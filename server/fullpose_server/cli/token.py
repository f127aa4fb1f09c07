"""`fullpose token`: what programs show instead of a password."""

from typing import Annotated

import typer

from fullpose_server.cli._arguments import Config
from fullpose_server.cli._people import DataDir, UserName, changing_people, day, people_of

TokenId = Annotated[str, typer.Argument(metavar="ID", help="As `fullpose token list` tells it.")]


def register(app: typer.Typer) -> None:
    """Add the commands."""
    group = typer.Typer(no_args_is_help=True, rich_markup_mode=None, help="Tokens, which programs show.")
    group.command("create", help="Make a token of a person: it is printed once, and kept nowhere.")(create)
    group.command("list", help="List tokens.")(listed)
    group.command("revoke", help="End a token; open connections end.")(revoke)
    app.add_typer(group, name="token")


def create(
    name: UserName,
    label: Annotated[str, typer.Option(help="What it is for.")] = "command line",
    role: Annotated[str | None, typer.Option(help="Less than the person's role.")] = None,
    days: Annotated[float | None, typer.Option(min=0.001, max=3650.0, help="Until it ends by itself.")] = None,
    data_dir: DataDir = None,
    config: Config = None,
) -> None:
    """Make a token; the first line of stdout is the token and nothing else."""
    from fullpose_server.cli.user import role_of

    with changing_people(data_dir, config) as (people, audit):
        given = people.make_token(name, label, None if role is None else role_of(role), days)
        audit("token create", f"{given.id} of {name}: {label}")
    typer.echo(given.secret)
    typer.echo(f"its id is {given.id}; it is kept nowhere: programs show it as Authorization: Bearer ...", err=True)


def listed(data_dir: DataDir = None, config: Config = None) -> None:
    """Print the tokens that were not revoked."""
    with people_of(data_dir, config) as people:
        rows = people.tokens()
    typer.echo(f"{'id':<13} {'of':<24} {'role':<9} {'made':<17} {'until':<17} for")
    for row in rows:
        whose = f"{row.id:<13} {row.user:<24} {row.role or 'theirs':<9}"
        typer.echo(f"{whose} {day(row.created):<17} {day(row.until):<17} {row.label}")


def revoke(token: TokenId, data_dir: DataDir = None, config: Config = None) -> None:
    """End a token."""
    with changing_people(data_dir, config) as (people, audit):
        row = people.revoke(token)
        audit("token revoke", f"{token} of {row.user}")
    typer.echo(f"{token} of {row.user} ({row.label}) is revoked")
