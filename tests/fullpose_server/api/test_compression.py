"""What is sent compressed is what was to be sent."""

import asyncio
import gzip
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st
from starlette.types import Message, Receive, Scope, Send

from fullpose_server.api.compression import Compression

LEAST = 1400


def answered(
    parts: list[bytes],
    *,
    accept: str | None = "gzip, br",
    status: int = 200,
    more: dict[str, str] | None = None,
    asked: dict[str, str] | None = None,
    method: str = "GET",
) -> tuple[dict[str, str], bytes, int]:
    """Headers, body and count of messages of an answer in these parts, as a client is sent it."""
    said: list[Message] = []
    headers = {"content-type": "application/json", "content-length": str(sum(map(len, parts)))} | (more or {})

    async def app(_scope: Scope, _receive: Receive, send: Send) -> None:
        raw = [(key.encode(), value.encode()) for key, value in headers.items()]
        await send({"type": "http.response.start", "status": status, "headers": raw})
        for i, part in enumerate(parts):
            await send({"type": "http.response.body", "body": part, "more_body": i < len(parts) - 1})

    async def keep(message: Message) -> None:
        said.append(message)

    async def never() -> Message:
        raise AssertionError

    wanted = {**({} if accept is None else {"accept-encoding": accept}), **(asked or {})}
    scope: dict[str, Any] = {
        "type": "http",
        "method": method,
        "headers": [(key.encode(), value.encode()) for key, value in wanted.items()],
    }
    asyncio.run(Compression(app)(scope, never, keep))
    head = {key.decode(): value.decode() for key, value in said[0]["headers"]}
    return head, b"".join(message["body"] for message in said[1:]), len(said)


@given(st.lists(st.binary(max_size=40_000), min_size=1, max_size=4))
def test_what_arrives_is_what_was_sent(parts: list[bytes]) -> None:
    head, body, messages = answered(parts)
    whole = b"".join(parts)
    packed = head.get("content-encoding") == "gzip"
    assert packed == (len(parts) > 1 or len(whole) >= LEAST)
    assert (gzip.decompress(body) if packed else body) == whole
    assert head.get("content-length") in (None, str(len(body)))
    assert messages == 1 + len(parts)


def test_json_gets_small() -> None:
    text = b'{"angles_deg": [0.1, 0.2, 0.3, 0.4]}' * 10_000
    head, body, _ = answered([text], more={"etag": '"e"'})
    assert len(body) < len(text) / 50
    assert (head["vary"], head["etag"]) == ("Accept-Encoding", 'W/"e"')


@pytest.mark.parametrize("accept", [None, "", "br", "identity", "gzip;q=0", "*;q=0", "gzip;q=1.2.3"])
def test_who_does_not_take_it_gets_it_as_it_is(accept: str | None) -> None:
    text = b"x" * 5000
    head, body, _ = answered([text], accept=accept)
    assert "content-encoding" not in head
    assert body == text


@pytest.mark.parametrize(
    "how",
    [
        {"status": 206},
        {"status": 304},
        {"more": {"content-encoding": "br"}},
        {"more": {"content-type": "text/csv"}},
        {"more": {"content-type": "application/octet-stream"}},
        {"more": {"content-range": "bytes 0-1/2"}},
        {"asked": {"range": "bytes=0-9"}},
        {"method": "HEAD"},
    ],
)
def test_what_is_better_left_alone_is(how: dict[str, Any]) -> None:
    head, body, _ = answered([b"y" * 5000], **how)
    assert head.get("content-encoding") != "gzip"
    assert body == b"y" * 5000
