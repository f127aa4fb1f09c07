"""The client's side of the lease, against a server that is made up: two rigs, each with epochs of its own."""

import asyncio
import base64
import json
from typing import Any

import httpx
import pytest

from fullpose_server.client import Client, ClientError

EPOCHS = {"one": 7, "two": 3}


@pytest.fixture
def asked() -> list[dict[str, Any]]:
    """What was asked about the lease."""
    return []


@pytest.fixture
def shown(monkeypatch: pytest.MonkeyPatch, asked: list[dict[str, Any]]) -> list[tuple[str, dict[str, Any]]]:
    """(rig, lease) of every command that the server is sent."""
    seen: list[tuple[str, dict[str, Any]]] = []

    async def answer(_: httpx.AsyncClient, method: str, url: str, **content: Any) -> httpx.Response:
        rig = url.split("/")[2]
        if url.endswith("/lease"):
            asked.append(content["json"])
            held = {"holder": "ann", "epoch": EPOCHS[rig], "sequence": 10, "expires_s": 5.0, "requested_by": []}
            given = None if "secret" in content["json"] else f"secret of {rig}"
            return httpx.Response(200, json=held | {"secret": given})
        seen.append((rig, content["json"]["lease"]))
        return httpx.Response(200, text=json.dumps({"command": content["json"]["command"], "method": method}))

    monkeypatch.setattr(httpx.AsyncClient, "request", answer)
    return seen


def test_each_rig_has_a_lease_of_its_own(shown: list[tuple[str, dict[str, Any]]]) -> None:
    async def operate() -> None:
        async with Client("http://127.0.0.1:1", name="ann") as client:
            await client.take_lease("one")
            await client.command("one", "connect")
            await client.take_lease("two")
            await client.command("two", "connect")
            await client.command("one", "arm")
            await client.take_lease("one", "renew")
            await client.command("one", "start")

    asyncio.run(operate())
    assert shown == [
        ("one", {"epoch": 7, "sequence": 11, "secret": "secret of one"}),
        ("two", {"epoch": 3, "sequence": 11, "secret": "secret of two"}),
        ("one", {"epoch": 7, "sequence": 12, "secret": "secret of one"}),
        ("one", {"epoch": 7, "sequence": 13, "secret": "secret of one"}),
    ]


def test_the_lease_is_kept_and_given_up_under_its_secret(
    shown: list[tuple[str, dict[str, Any]]], asked: list[dict[str, Any]]
) -> None:
    async def operate() -> None:
        async with Client("http://127.0.0.1:1", name="ann") as client:
            with pytest.raises(ClientError, match="does not hold the lease of one"):
                await client.release_lease("one")
            assert "secret" not in await client.take_lease("one")
            for again in ("take", "renew", "grant"):
                await client.take_lease("one", again)
            await client.release_lease("one")
            await client.command("one", "connect")

    asyncio.run(operate())
    secret = {"secret": "secret of one"}
    under = [{"action": word} | secret for word in ("renew", "renew", "grant", "release")]
    assert asked == [{"action": "take"}, *under]
    assert shown == [("one", None)]


def test_a_password_in_the_address_is_sent_decoded_and_told_to_nobody() -> None:
    """A WebSocket's library sends it as it is written, percent signs and all."""

    async def refused() -> tuple[Client, str]:
        async with Client("http://ann:a%20%C3%A4@127.0.0.1:1/") as client:
            with pytest.raises(ClientError) as error:
                async with client.stream("one"):
                    pass
            return client, str(error.value)

    client, message = asyncio.run(refused())
    assert client.url == "http://127.0.0.1:1"
    assert "ann" not in message
    credentials = base64.b64decode(client._headers["Authorization"].removeprefix("Basic "))
    assert credentials.decode() == "ann:a ä"
