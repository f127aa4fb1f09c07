"""Answers are sent compressed (gzip, RFC 1952) to who takes them so: JSON, and the console's scripts and styles.

An ASGI middleware. What is large is compressed in a thread, so that the event loop serves others meanwhile; Stop and
E-stop have a process of their own and never wait for it. What is compressed already, is exported (perhaps gigabytes
beside a loop of 1 kHz), asked for in parts or too short to gain stays as it is: a lease's secret among them, whose
length under compression could tell of it (BREACH).
"""

import asyncio
import re
import zlib

from starlette.datastructures import Headers, MutableHeaders
from starlette.types import ASGIApp, Message, Receive, Scope, Send

_TYPES = re.compile(r"(application/(json|problem\+json|javascript)|text/(html|css|javascript)|image/svg\+xml)\b")
_LEAST = 1400  # bytes: less fits into one packet
_AT_ONCE = 16_384  # bytes that take a fraction of a millisecond
_LEVEL = 5
_GZIP = 16 + zlib.MAX_WBITS
_BODILESS = frozenset({204, 206, 304})


class Compression:
    """ASGI middleware."""

    def __init__(self, app: ASGIApp) -> None:
        self._app = app

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Let it through, compressed where that is taken and worth it."""
        if scope["type"] != "http" or scope["method"] == "HEAD" or not takes_gzip(Headers(scope=scope)):
            await self._app(scope, receive, send)
            return
        await self._app(scope, receive, _Compressed(send).send)


def takes_gzip(asked: Headers) -> bool:
    """Whether a client takes gzip (RFC 9110, section 12.5.3), and the answer as a whole."""
    if "range" in asked:
        return False
    weights: dict[str, float] = {}
    for each in asked.get("accept-encoding", "").split(","):
        name, _, parameters = each.partition(";")
        weight = re.fullmatch(r"\s*q=([0-9.]+)\s*", parameters)
        try:
            weights[name.strip().lower()] = float(weight[1]) if weight else 1.0
        except ValueError:
            return False
    return weights.get("gzip", weights.get("*", 0.0)) > 0.0


class _Compressed:
    """What an app sends, compressed on the way; the head waits for the first part of the body, which may be all."""

    def __init__(self, send: Send) -> None:
        self._send = send
        self._head: Message | None = None
        self._packer = zlib.compressobj(_LEVEL, zlib.DEFLATED, _GZIP)
        self._packing = False

    async def send(self, message: Message) -> None:
        if message["type"] == "http.response.start":
            self._head = message
            return
        if message["type"] != "http.response.body":
            await self._send(message)
            return
        body, more = message.get("body", b""), message.get("more_body", False)
        if self._head is not None:
            head, self._head = self._head, None
            self._packing = _worth_it(head, len(body), more)
            if self._packing:
                body = await self._packed(body, more)
                _say_so(head, None if more else len(body))
            await self._send(head)
        elif self._packing:
            body = await self._packed(body, more)
        await self._send({**message, "body": body})

    async def _packed(self, body: bytes, more: bool) -> bytes:
        return self._pack(body, more) if len(body) < _AT_ONCE else await asyncio.to_thread(self._pack, body, more)

    def _pack(self, body: bytes, more: bool) -> bytes:
        return self._packer.compress(body) + (b"" if more else self._packer.flush())


def _worth_it(head: Message, size: int, more: bool) -> bool:
    headers = MutableHeaders(raw=head["headers"])
    if head["status"] in _BODILESS or "content-encoding" in headers or "content-range" in headers:
        return False
    return (more or size >= _LEAST) and _TYPES.match(headers.get("content-type", "")) is not None


def _say_so(head: Message, size: int | None) -> None:
    """`size` [bytes] of the whole; None where it is not known yet. A validator holds weakly."""
    headers = MutableHeaders(raw=head["headers"])
    headers["content-encoding"] = "gzip"
    headers.add_vary_header("Accept-Encoding")
    if "etag" in headers and not headers["etag"].startswith("W/"):
        headers["etag"] = f"W/{headers['etag']}"
    if size is not None:
        headers["content-length"] = str(size)
    elif "content-length" in headers:
        del headers["content-length"]
    head["headers"] = headers.raw
