"""`fullpose serve`: the server with console and scene on one port."""

from pathlib import Path
from typing import Annotated

import typer

from fullpose_server.cli._arguments import Config


def register(app: typer.Typer) -> None:
    """Add the command."""
    app.command("serve", help="Serve the console, the scene and the API on one port.")(serve)


def serve(
    host: Annotated[str | None, typer.Option(help="Address to listen on (127.0.0.1).")] = None,
    port: Annotated[int | None, typer.Option(help="Port to listen on (8642); 0 takes a free one.")] = None,
    data_dir: Annotated[Path | None, typer.Option(help="Where everything is kept (~/.local/share/fullpose).")] = None,
    config: Config = None,
) -> None:
    """Serve until Ctrl-C. Every setting is also read from the environment, as FULLPOSE_HOST, and from a file."""
    from fullpose_server.cli._configuration import configured, to_serve
    from fullpose_server.cli._serving import run

    async def ready(_url: str) -> None:
        return

    run(to_serve(configured(host, port, data_dir, config)).settings, ready)
