"""What a connection wants is told by its first request, however it is cut into pieces."""

import json
from itertools import pairwise

import pytest
from hypothesis import given
from hypothesis import strategies as st

from fullpose_server.gate.first_request import MAX_BODY, MAX_HEAD, FirstRequest, Rest, StopOf, Wanted
from fullpose_server.session.states import NEEDS_NO_LEASE, Command

UPGRADE = "Upgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Key: AAAAAAAAAAAAAAAAAAAAAA==\r\n"


def request(method: str, path: str, body: bytes = b"", headers: str = "", length: int | None = None) -> bytes:
    size = f"Content-Length: {len(body) if length is None else length}\r\n" if body or length else ""
    return f"{method} {path} HTTP/1.1\r\nHost: here\r\n{headers}{size}\r\n".encode() + body


def command(word: object, **more: object) -> bytes:
    return json.dumps({"command": word} | more).encode()


CASES: list[tuple[bytes, Wanted]] = [
    (request("POST", "/api/v1/rigs/a/stop"), StopOf("a")),
    (request("POST", "/api/v1/rigs/a/estop?x=1"), StopOf("a")),
    (request("POST", "/api/v1/rigs/%61%20b/estop"), StopOf("a b")),
    (request("POST", "/api/v1/rigs/a/estop", length=10**8), StopOf("a")),  # before its body has come
    (request("POST", "/api/v1/rigs/a/estop", headers="X-Fullpose-Client: joe b\r\n"), StopOf("a")),
    (request("POST", "/api/v1/rigs/a/commands", command("estop")), StopOf("a")),
    (request("POST", "/api/v1/rigs/a/commands", command("stop", lease=7, args=[])), StopOf("a")),
    (request("GET", "/api/v1/stop", headers=UPGRADE), StopOf(None)),
    (request("GET", "/api/v1/stop"), Rest()),
    (request("GET", "/api/v1/rigs/a/stop"), Rest()),
    (request("POST", "/api/v1/rigs/a/lease"), Rest()),
    (request("POST", "/api/v1/rigs/a/b/stop"), Rest()),
    (request("POST", "/api/v1/stop"), Rest()),
    (request("GET", "/api/v1/rigs/a/stream", headers=UPGRADE), Rest()),
    (request("GET", "/") + request("POST", "/api/v1/rigs/a/stop"), Rest()),  # the first decides
    (request("POST", "/api/v1/rigs/a/commands", b"[1]"), Rest()),
    (request("POST", "/api/v1/rigs/a/commands", b"\xff\xfe"), Rest()),
    (request("POST", "/api/v1/rigs/a/commands", command(3)), Rest()),
    (request("POST", "/api/v1/rigs/a/commands", b"{" + b" " * MAX_BODY), Rest()),
    (b"\x16\x03\x01\x02\x00\x01\x00\x01\xfc", Rest()),  # TLS
    (b"GET / HTTP/1.1\r\nX: " + b"x" * (MAX_HEAD + MAX_BODY), Rest()),
]
CHUNKED = "Transfer-Encoding: chunked\r\n"


@pytest.mark.parametrize(("data", "wanted"), CASES)
def test_at_once(data: bytes, wanted: Wanted) -> None:
    assert FirstRequest().feed(data) == wanted


@given(st.sampled_from(CASES[:-2]), st.lists(st.integers(0, 400), max_size=6))
def test_in_pieces(case: tuple[bytes, Wanted], cuts: list[int]) -> None:
    data, wanted = case
    edges = [0, *sorted(min(cut, len(data)) for cut in cuts), len(data)]
    first = FirstRequest()
    found: Wanted = None
    for begin, end in pairwise(edges):
        if begin < end and found is None:
            found = first.feed(data[begin:end])
    assert found == wanted
    assert data.startswith(bytes(first.data))


@pytest.mark.parametrize("word", list(Command))
def test_every_command_chunked(word: Command) -> None:
    head = request("POST", "/api/v1/rigs/a/commands", headers=CHUNKED)
    body = command(word)
    first = FirstRequest()
    assert first.feed(head) is None
    assert first.feed(f"{len(body):x}\r\n".encode()) is None
    wanted = first.feed(body + b"\r\n0\r\n\r\n")
    assert wanted == (StopOf("a") if word in NEEDS_NO_LEASE else Rest())


@given(st.binary(max_size=300))
def test_nothing_breaks_it(data: bytes) -> None:
    FirstRequest().feed(data)
