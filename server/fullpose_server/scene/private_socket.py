"""Where a scene's viser listens: a Unix socket in a folder of this user's alone, for the proxy. No browser can open it.

On a loopback port, as viser would have it, any page of any site could reach it from the operator's own browser.
"""

import socket
import tempfile
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import websockets.asyncio.server as listening

from fullpose_server.runtime.contract.rig_paths import SocketAddress
from fullpose_server.scene.errors import SceneSocketError

_BACKLOG = 128
_installing = threading.Lock()


class PrivateSocket:
    """A Unix socket that listens, under a name that only this user can reach. Raises OSError where there is no room."""

    def __init__(self) -> None:
        self._folder = tempfile.TemporaryDirectory(prefix="fullpose-scene-")  # mode 0700
        self.listener = socket.socket(socket.AF_UNIX, socket.SOCK_STREAM | socket.SOCK_CLOEXEC)
        try:
            with self.address() as path:
                self.listener.bind(path)
            self.listener.listen(_BACKLOG)
        except OSError:
            self.close()
            raise

    def address(self) -> SocketAddress:
        """For who connects."""
        return SocketAddress(Path(self._folder.name), "viser.sock")

    def close(self) -> None:
        """Nobody can connect any more."""
        self.listener.close()
        self._folder.cleanup()


class Host(str):
    """The host that viser is told, and hands on as it is: it stands for a socket."""

    __slots__ = ("_listener", "taken")
    _listener: socket.socket
    taken: bool

    def __new__(cls, listener: socket.socket) -> "Host":
        """It reads as loopback."""
        host = super().__new__(cls, "127.0.0.1")
        host._listener = listener
        host.taken = False
        return host

    def take(self) -> socket.socket:
        """The socket, for who listens on it."""
        self.taken = True
        return self._listener


@contextmanager
def host_for(private: PrivateSocket) -> Iterator[Host]:
    """What viser is to be told as its host, inside; it has no setting for a socket.

    It asks `websockets` to listen at a host: where that is one of these, `websockets` listens on the socket instead.
    Raises `SceneSocketError` at the end where viser asked in another way.
    """
    host = Host(private.listener)
    with _installing:
        serve = listening.serve
        listening.serve = _serving(serve)  # type: ignore[misc,assignment]
        try:
            yield host
        finally:
            listening.serve = serve  # type: ignore[misc]
    if not host.taken:
        raise SceneSocketError("viser listens in a way of its own, which any page could reach: it is not used")


def _serving(serve: Callable[..., Any]) -> Callable[..., Any]:
    def on(handler: Any, host: Any = None, port: Any = None, **options: Any) -> Any:
        if not isinstance(host, Host):
            return serve(handler, host, port, **options)
        return serve(handler, unix=True, sock=host.take(), **options)

    return on
