"""Before the server runs: its log and its socket, and what is wrong with it. Shared by `serve` and `demo`."""

import errno
import socket
import time
from collections.abc import Awaitable, Callable

from fullpose_server.cli._exit import fail, say
from fullpose_server.logs import configure
from fullpose_server.settings import Settings

BACKLOG = 512
FREE_S = 5.0  # the gate that a killed server had just started holds the port until it has begun and finds itself alone
UNSENT = 16_384  # bytes the system may hold unsent for a client; what is older than that would only make it late
Ready = Callable[[str], Awaitable[None]]


def run(settings: Settings, ready: Ready) -> None:
    """Serve until SIGINT or SIGTERM. The address is the first line of stdout; then `ready` runs beside the server."""
    configure(settings.log)
    listener = bind(settings.host, settings.port)
    from fullpose_server.cli._event_loop import serve  # seconds; what can be refused without it has been

    serve(settings, listener, address(listener), ready)


def bind(host: str, port: int) -> socket.socket:
    """The listening socket. Exits with a clear line where the port is taken or the host is not ours."""
    family = socket.AF_INET6 if ":" in host else socket.AF_INET
    # The protocol is said outright: asyncio sets TCP_NODELAY only on sockets that say it, and without it every small
    # answer waits 40 ms for the other side's delayed acknowledgement.
    listener = socket.socket(family, socket.SOCK_STREAM, socket.IPPROTO_TCP)
    listener.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
    if hasattr(socket, "TCP_NOTSENT_LOWAT"):
        listener.setsockopt(socket.IPPROTO_TCP, socket.TCP_NOTSENT_LOWAT, UNSENT)  # accepted sockets inherit it
    try:
        _bind(listener, host.strip("[]"), port)
        listener.listen(BACKLOG)
    except OSError as error:
        listener.close()
        if error.errno == errno.EADDRINUSE:
            fail(f"port {port} on {host} is in use by another program: stop it, or choose another with --port")
        fail(f"cannot listen on {host} port {port}: {error.strerror or error}")
    return listener


def _bind(listener: socket.socket, host: str, port: int) -> None:
    began, waited = time.monotonic(), False
    while True:
        try:
            listener.bind((host, port))
            break
        except OSError as error:
            if error.errno != errno.EADDRINUSE or time.monotonic() - began > FREE_S:
                raise
        waited = True
        time.sleep(0.05)
    if waited:
        say(f"port {port} on {host} was in use: waited {time.monotonic() - began:.1f} s for it")


def address(listener: socket.socket) -> str:
    """The URL of the console."""
    host, port = listener.getsockname()[:2]
    if host in ("0.0.0.0", "::"):
        host = "localhost"
    return f"http://[{host}]:{port}" if ":" in host else f"http://{host}:{port}"
