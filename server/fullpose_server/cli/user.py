"""`fullpose user`: people and their roles. The first one is made here, and from then on everybody signs in."""

import sys
from pathlib import Path
from typing import Annotated, Any

import typer

from fullpose_server.cli._arguments import Config
from fullpose_server.cli._exit import fail
from fullpose_server.cli._people import DataDir, UserName, changing_people, day, people_of

RoleName = Annotated[str, typer.Option("--role", help="viewer (sees), operator (commands) or admin (people too).")]
FromStdin = Annotated[bool, typer.Option("--password-stdin", help="Read the password from standard input.")]
RevokeTokens = Annotated[bool, typer.Option("--revoke-tokens", help="Revoke their tokens too; they stay otherwise.")]
WithoutPassword = Annotated[bool, typer.Option("--no-password", help="They sign in elsewhere, or by token only.")]


def register(app: typer.Typer) -> None:
    """Add the commands."""
    group = typer.Typer(no_args_is_help=True, rich_markup_mode=None, help="People who may use a server.")
    group.command("add", help="Add a person; the password is asked for.")(add)
    group.command("list", help="List people, their roles and whether they are let in.")(listed)
    group.command("role", help="Give a person another role.")(role)
    group.command("password", help="Set a person's password; their sessions end.")(password)
    group.command("disable", help="Let a person in no longer; open connections end.")(disable)
    group.command("enable", help="Let a person in again.")(enable)
    app.add_typer(group, name="user")


def add(
    name: UserName,
    role: RoleName,
    password_stdin: FromStdin = False,
    no_password: WithoutPassword = False,
    data_dir: DataDir = None,
    config: Config = None,
) -> None:
    """Add a person."""
    from fullpose_server.api.stopping import is_name

    if not is_name(name):
        fail(f"user {name!r}: expected up to 64 letters, digits or . @ : + - _")
    if password_stdin and no_password:
        fail("--password-stdin and --no-password: expected one of them")
    known = role_of(role)
    with changing_people(data_dir, config) as (people, audit):
        if people.get(name) is not None:
            fail(f"there is a user {name} already: expected another name")
        people.add(name, known, None if no_password else _password(password_stdin))
        audit("user add", f"{name}: {known}")
    typer.echo(f"{name} is {known}")


def listed(data_dir: DataDir = None, config: Config = None) -> None:
    """Print everybody."""
    with people_of(data_dir, config) as people:
        rows = people.all()
    if not rows:
        typer.echo("no users: a server on this data folder listens on this machine only, and asks nobody to sign in")
        return
    typer.echo(f"{'name':<24} {'role':<9} {'let in':<7} {'password':<9} since")
    for row in rows:
        words = ("no" if row.disabled else "yes", "no" if row.password is None else "yes")
        typer.echo(f"{row.name:<24} {row.role:<9} {words[0]:<7} {words[1]:<9} {day(row.created)}")


def role(name: UserName, role: RoleName, data_dir: DataDir = None, config: Config = None) -> None:
    """Give a person another role."""
    known = role_of(role)
    with changing_people(data_dir, config) as (people, audit):
        row = people.change(name, role=known)
        audit("user change", f"{name}: role {known}")
    typer.echo(f"{row.name} is {row.role}")


def password(
    name: UserName,
    password_stdin: FromStdin = False,
    revoke_tokens: RevokeTokens = False,
    data_dir: DataDir = None,
    config: Config = None,
) -> None:
    """Set a person's password."""
    with changing_people(data_dir, config) as (people, audit):
        row = people.get(name)
        if row is None:
            fail(f"no user named {name!r}")
        people.set_password(row.name, _password(password_stdin), revoke_tokens=revoke_tokens)
        audit("password", f"{row.name}: tokens revoked" if revoke_tokens else row.name)
        left = len(people.tokens(row.name))
    ended = "their sessions and tokens have ended" if revoke_tokens else "their sessions have ended"
    typer.echo(f"{row.name} has another password, and {ended}")
    if left:
        typer.echo(f"tokens that stay: {left} (--revoke-tokens, or `fullpose token revoke`, ends them)")


def disable(name: UserName, data_dir: DataDir = None, config: Config = None) -> None:
    """Let a person in no longer."""
    _let_in(name, disabled=True, data_dir=data_dir, config=config)


def enable(name: UserName, data_dir: DataDir = None, config: Config = None) -> None:
    """Let a person in again."""
    _let_in(name, disabled=False, data_dir=data_dir, config=config)


def _let_in(name: str, *, disabled: bool, data_dir: Path | None, config: Path | None) -> None:
    with changing_people(data_dir, config) as (people, audit):
        row = people.change(name, disabled=disabled)
        audit("user change", f"{name}: {'disabled' if disabled else 'enabled'}")
    typer.echo(f"{row.name} is {'let in no longer' if disabled else 'let in'}")


def role_of(word: str) -> Any:
    """The role of that name. Exits with a clear line where there is none."""
    from fullpose_server.people.roles import Role

    if word not in list(Role):
        fail(f"--role {word}: expected {', '.join(Role)}")
    return Role(word)


def _password(stdin: bool) -> str:
    if stdin:
        return sys.stdin.readline().rstrip("\n")
    if not sys.stdin.isatty():
        fail("no terminal to ask for the password: give it by --password-stdin")
    asked: str = typer.prompt("Password", hide_input=True, confirmation_prompt=True, err=True)
    return asked
