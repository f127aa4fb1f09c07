"""Running the server: one socket, one event loop, an orderly end. Shared by `serve` and `demo`."""

import asyncio
import contextlib
import errno
import logging
import signal
import socket
import sys
from collections.abc import Awaitable, Callable, Iterator
from pathlib import Path
from typing import Any

import uvicorn

from server.app import create_app
from server.cli._exit import fail
from server.client import ClientError
from server.runtime.host import HostError
from server.settings import Settings
from server.store.errors import StoreError

BACKLOG = 512
UNSENT = 16_384  # bytes the system may hold unsent for a client; what is older than that would only make it late
UNAUTHENTICATED = (
    "no users are configured, so this server listens on this machine only: use --host 127.0.0.1, or allow the network "
    "with FULLPOSE_ALLOW_UNAUTHENTICATED_NETWORK=true"
)

Ready = Callable[[str], Awaitable[None]]


def settings_of(host: str | None, port: int | None, data_dir: Path | None) -> Settings:
    """Settings from the environment, with what the command line says over them. Exits where they cannot be."""
    given: dict[str, Any] = {"host": host, "port": port, "data_dir": data_dir}
    try:
        settings = Settings(**{key: value for key, value in given.items() if value is not None})
    except ValueError as error:
        fail(f"settings: {error}")
    if not settings.loopback and not settings.allow_unauthenticated_network:
        fail(f"--host {settings.host}: {UNAUTHENTICATED}")
    return settings


def run(settings: Settings, ready: Ready) -> None:
    """Serve until SIGINT or SIGTERM. The address is the first line of stdout; then `ready` runs beside the server."""
    logging.basicConfig(format="%(asctime)s %(name)s %(message)s", level=logging.WARNING, stream=sys.stderr)
    listener = bind(settings.host, settings.port)
    try:
        asyncio.run(_run(settings, listener, ready))
    except StoreError as error:
        fail(str(error))
    except (HostError, ClientError) as error:
        fail(str(error), 1)


def bind(host: str, port: int) -> socket.socket:
    """The listening socket. Exits with a clear line where the port is taken or the host is not ours."""
    family = socket.AF_INET6 if ":" in host else socket.AF_INET
    listener = socket.socket(family, socket.SOCK_STREAM)
    listener.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
    if hasattr(socket, "TCP_NOTSENT_LOWAT"):
        listener.setsockopt(socket.IPPROTO_TCP, socket.TCP_NOTSENT_LOWAT, UNSENT)  # accepted sockets inherit it
    try:
        listener.bind((host.strip("[]"), port))
    except OSError as error:
        listener.close()
        if error.errno == errno.EADDRINUSE:
            fail(f"port {port} on {host} is in use by another program: stop it, or choose another with --port")
        fail(f"cannot listen on {host} port {port}: {error.strerror or error}")
    listener.listen(BACKLOG)
    return listener


def address(listener: socket.socket) -> str:
    """The URL of the console."""
    host, port = listener.getsockname()[:2]
    if host in ("0.0.0.0", "::"):
        host = "localhost"
    return f"http://[{host}]:{port}" if ":" in host else f"http://{host}:{port}"


async def _run(settings: Settings, listener: socket.socket, ready: Ready) -> None:
    app = create_app(settings)
    config = uvicorn.Config(
        app,
        lifespan="off",  # ours, below: its errors are for the person at the terminal
        log_config=None,
        access_log=False,
        ws_per_message_deflate=False,  # telemetry is small and frequent
        timeout_graceful_shutdown=3,
        server_header=False,
    )
    async with app.router.lifespan_context(app):
        server = _Server(config)
        serving = asyncio.create_task(server.serve(sockets=[listener]))
        sys.stdout.write(f"{address(listener)}\n")
        sys.stdout.flush()
        beside = asyncio.create_task(_beside(ready, address(listener), server))
        await serving
        beside.cancel()
        results = await asyncio.gather(beside, return_exceptions=True)
    for result in results:
        if isinstance(result, Exception):
            raise result


async def _beside(ready: Ready, url: str, server: uvicorn.Server) -> None:
    try:
        await ready(url)
    except Exception:
        if not server.should_exit:  # at the end every connection of ours breaks off too
            server.should_exit = True
            raise


class _Server(uvicorn.Server):
    """Ends at a signal without raising it again afterwards: what follows is our own orderly end."""

    @contextlib.contextmanager
    def capture_signals(self) -> Iterator[None]:
        loop = asyncio.get_running_loop()
        for number in (signal.SIGINT, signal.SIGTERM):
            loop.add_signal_handler(number, self.handle_exit, number, None)
        try:
            yield
        finally:
            for number in (signal.SIGINT, signal.SIGTERM):
                loop.remove_signal_handler(number)
                # The end has begun; a second signal must not cut it short and leave a rig moving.
                signal.signal(number, signal.SIG_IGN)
