"""What a connection wants, by its first request: a stop, which is served here, or anything else. Knows no socket."""

from dataclasses import dataclass
from urllib.parse import unquote

import httptools
import msgspec

from fullpose_server.api.paths import API, STOP_CHANNEL, of_rig
from fullpose_server.session.states import NEEDS_NO_LEASE

MAX_HEAD = 1 << 16  # [bytes] of a longer one the server may think what it likes
MAX_BODY = 1 << 16  # [bytes] of a command; no stop needs as much
_CHANNEL = f"{API}{STOP_CHANNEL}"


@dataclass(frozen=True)
class StopOf:
    """A stop of this rig; None: the channel, which is for all."""

    rig: str | None


@dataclass(frozen=True)
class Rest:
    """Anything else, for the server."""


Wanted = StopOf | Rest | None  # None: it cannot be told yet


class _Word(msgspec.Struct):
    command: str


_word = msgspec.json.Decoder(_Word).decode


class FirstRequest:
    """Reads a connection's first bytes, as they come."""

    def __init__(self) -> None:
        self.data = bytearray()  # all of them, for whoever serves it
        self._parser = httptools.HttpRequestParser(self)
        self._url = b""
        self._rig = ""
        self._body = bytearray()
        self._wanted: Wanted = None

    def feed(self, data: bytes) -> Wanted:
        """What is wanted, as far as it can be told."""
        self.data += data
        try:
            self._parser.feed_data(data)
        except httptools.HttpParserUpgrade:
            pass  # it was told by its head
        except httptools.HttpParserError:
            self._wanted = self._wanted or Rest()  # the server says what is wrong with it
        if self._wanted is None and len(self.data) > MAX_HEAD + MAX_BODY:
            return Rest()
        return self._wanted

    # --- what the parser finds ---

    def on_url(self, url: bytes) -> None:
        """A part of the target."""
        self._url += url

    def on_headers_complete(self) -> None:
        """The head is whole."""
        if self._wanted is not None:
            return  # of another request, sent before this one was answered
        method, path = self._parser.get_method(), unquote(self._url.split(b"?", 1)[0].decode("latin-1"))
        if method == b"GET" and path == _CHANNEL and self._parser.should_upgrade():
            self._wanted = StopOf(None)
            return
        target = of_rig(path) if method == b"POST" else None
        if target is None:
            self._wanted = Rest()
            return
        self._rig, word = target
        if word in NEEDS_NO_LEASE:
            self._wanted = StopOf(self._rig)
        elif word != "commands":
            self._wanted = Rest()

    def on_body(self, data: bytes) -> None:
        """A part of the body of a command."""
        if self._wanted is None:
            self._body += data
            if len(self._body) > MAX_BODY:
                self._wanted = Rest()

    def on_message_complete(self) -> None:
        """The command is whole."""
        if self._wanted is not None:
            return
        try:
            word = _word(self._body).command
        except (msgspec.DecodeError, UnicodeDecodeError):
            word = ""
        self._wanted = StopOf(self._rig) if word in NEEDS_NO_LEASE else Rest()
