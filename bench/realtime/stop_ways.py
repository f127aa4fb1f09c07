"""How a stop is asked: over HTTP, over the stop channel, and beside them of a bare uvicorn that says ok.

The channel is a plain socket: the thread that asks is the one that reads, with the priority of the measurement.
"""

import base64
import http.client
import json
import os
import select
import socket
from typing import Any

from bench.realtime.estop_latency import RIG, ask

_PATIENCE_S = 10.0
_TEXT, _PING, _PONG = 0x81, 0x89, 0x8A  # a WebSocket frame's first byte


class Channel:
    """The stop channel, open all the time (RFC 6455, unfragmented text)."""

    def __init__(self, port: int) -> None:
        self._socket = socket.create_connection(("127.0.0.1", port), timeout=60)
        self._socket.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        key = base64.b64encode(os.urandom(16)).decode()
        self._socket.sendall(
            f"GET /api/v1/stop HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
            f"Sec-WebSocket-Key: {key}\r\nSec-WebSocket-Version: 13\r\n\r\n".encode()
        )
        self._data = b""
        while b"\r\n\r\n" not in self._data:
            self._read()
        head, self._data = self._data.split(b"\r\n\r\n", 1)
        assert b" 101 " in head.splitlines()[0], head
        self._socket.settimeout(_PATIENCE_S)

    def say(self, message: dict[str, Any]) -> dict[str, Any]:
        """Send it, and wait for the answer. Raises `OSError`."""
        self._send(_TEXT, json.dumps(message).encode())
        while True:
            kind, payload = self._frame()
            if kind == _PING:
                self._send(_PONG, payload)
            elif kind == _TEXT:
                answer: dict[str, Any] = json.loads(payload)
                return answer

    def listen(self) -> None:
        """Answer the pings that have come, as a browser does by itself: a channel that does not is closed."""
        while self._data or select.select([self._socket], [], [], 0.0)[0]:
            kind, payload = self._frame()
            if kind == _PING:
                self._send(_PONG, payload)

    def close(self) -> None:
        """No more."""
        self._socket.close()

    def _send(self, kind: int, payload: bytes) -> None:
        assert len(payload) < 126
        # A client's frames are masked; a mask of zeros leaves them as they are.
        self._socket.sendall(bytes([kind, 0x80 | len(payload)]) + bytes(4) + payload)

    def _frame(self) -> tuple[int, bytes]:
        head = self._take(2)
        size = head[1] if head[1] < 126 else int.from_bytes(self._take(2 if head[1] == 126 else 8), "big")
        return head[0], self._take(size)

    def _take(self, size: int) -> bytes:
        while len(self._data) < size:
            self._read()
        taken, self._data = self._data[:size], self._data[size:]
        return taken

    def _read(self) -> None:
        got = self._socket.recv(65536)
        if not got:
            raise ConnectionError("the server has closed the stop channel")
        self._data += got


class Ways:
    """How a stop is asked. Each raises `AssertionError` where it is refused, or not answered as it should."""

    def __init__(self, port: int, bare: int) -> None:
        self._port, self._bare = port, bare
        self._channel = Channel(port)

    def http(self, word: str) -> None:
        """A connection of its own."""
        ask(self._port, word)

    def channel(self, word: str) -> None:
        """The stop channel."""
        answer = self._channel.say({"type": word, "rig": RIG})
        assert answer["type"] == "stopped", answer
        assert answer["done"]["unknown"] is None, answer

    def bare(self) -> None:
        """A bare uvicorn that says ok; asked after every stop, so the channel is listened to here."""
        self._channel.listen()
        link = http.client.HTTPConnection("127.0.0.1", self._bare, timeout=60)
        link.request("POST", "/", b"")
        link.getresponse().read()
        link.close()

    def close(self) -> None:
        """No more."""
        self._channel.close()
