"""The rig process's end of the control socket: polled once a tick, never blocking, a few messages at a time.

Who is slow to read its answers is not read either until it has: one answer waits for it, and its requests queue in the
socket, with whoever sends them. None is lost, and none is obeyed without being answered.
"""

import select
import socket
from collections.abc import Callable

import msgspec

from fullpose_server.runtime.contract import messages
from fullpose_server.runtime.contract.rig_paths import RigPaths, control_socket

_PER_TICK = 4
_CLIENTS = 8


class ControlServer:
    """Listens in a rig's directory. `poll` answers what has come."""

    def __init__(self, paths: RigPaths, handle: Callable[[messages.Request], messages.Answer]) -> None:
        self._handle = handle
        self._listener = control_socket()
        with paths.socket_address("control.sock") as address:
            (paths.directory / "control.sock").unlink(missing_ok=True)
            self._listener.bind(address)
        self._listener.listen(_CLIENTS)
        self._clients: dict[int, socket.socket] = {}
        self._unsent: dict[int, bytes] = {}  # the answer that a full socket has not taken yet
        self._poll = select.epoll()
        self._poll.register(self._listener.fileno(), select.EPOLLIN)

    def poll(self) -> None:
        """Handle at most a few waiting messages: a full queue takes many ticks, and the loop stays on time."""
        for fd, _ in self._poll.poll(0, _PER_TICK):
            if fd == self._listener.fileno():
                self._accept()
            elif fd in self._unsent:
                self._send(fd, self._unsent[fd])
            else:
                self._read(fd)

    def close(self) -> None:
        """Close every connection."""
        for client in self._clients.values():
            client.close()
        self._poll.close()
        self._listener.close()

    def _accept(self) -> None:
        try:
            client, _ = self._listener.accept()
        except OSError:
            return  # gone before we came
        if len(self._clients) >= _CLIENTS:
            client.close()
            return
        client.setblocking(False)
        self._clients[client.fileno()] = client
        self._poll.register(client.fileno(), select.EPOLLIN)

    def _read(self, fd: int) -> None:
        client = self._clients[fd]
        try:
            packet = client.recv(messages.MAX_REQUEST)
        except BlockingIOError:
            return
        except OSError:
            packet = b""
        if not packet:
            self._drop(fd)
            return
        try:
            request = messages.decode_request(packet)
        except (msgspec.DecodeError, UnicodeDecodeError):
            self._drop(fd)  # not our server: it gets no second try
            return
        self._send(fd, messages.encode(self._handle(request)))

    def _send(self, fd: int, answer: bytes) -> None:
        try:
            self._clients[fd].send(answer)
        except BlockingIOError:
            self._unsent[fd] = answer
            self._poll.modify(fd, select.EPOLLOUT)
        except OSError:
            self._drop(fd)  # gone before its answer
        else:
            if self._unsent.pop(fd, None) is not None:
                self._poll.modify(fd, select.EPOLLIN)

    def _drop(self, fd: int) -> None:
        self._unsent.pop(fd, None)
        self._poll.unregister(fd)
        self._clients.pop(fd).close()
