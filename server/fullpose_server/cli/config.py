"""`fullpose config check`: whether a server would start with the settings as they are, and where each comes from."""

import json
from pathlib import Path
from typing import Annotated, Any

import typer

from fullpose_server.cli._arguments import Config


def register(app: typer.Typer) -> None:
    """Add the command."""
    group = typer.Typer(no_args_is_help=True, rich_markup_mode=None, help="The settings of a server.")
    group.callback()(_group)
    group.command("check", help="Check the settings, and print each with where it comes from.")(check)
    app.add_typer(group, name="config")


def _group() -> None:
    """The settings of a server."""


def check(
    config: Config = None,
    data_dir: Annotated[Path | None, typer.Option(help="Where everything is to be kept.")] = None,
) -> None:
    """Print the settings as a file of them, each with its origin. Exit 2 where one cannot be, or is none."""
    from fullpose_server.cli._configuration import configured, to_serve

    found = to_serve(configured(data_dir=data_dir, config=config))
    shown = found.settings.model_dump(mode="json")
    if found.settings.database_url is not None:
        shown["database_url"] = str(found.settings.database)  # all of it but the password
    for name, value in shown.items():
        line = f"# {name} is unset" if value is None else f"{name} = {_toml(value)}"
        typer.echo(f"{line:<48}  # {found.origins.get(name, 'default')}")


def _toml(value: Any) -> str:
    if isinstance(value, dict):
        return "{" + ", ".join(f"{json.dumps(key)} = {_toml(one)}" for key, one in value.items()) + "}"
    return json.dumps(value, ensure_ascii=False)
