"""A file made for one answer does not outlive it, whoever leaves."""

import asyncio
from pathlib import Path

import pytest
from starlette.types import Message

from fullpose_server.api.answer_file import AnswerFile

SCOPE = {"type": "http", "method": "GET", "headers": [], "asgi": {"spec_version": "2.4"}}


def sent(path: Path, left: bool) -> list[Message]:
    messages: list[Message] = []

    async def send(message: Message) -> None:
        if left and message["type"] == "http.response.body":
            raise OSError("the client has left")
        messages.append(message)

    async def receive() -> Message:
        return {"type": "http.disconnect"}

    path.write_bytes(b"answer")
    asyncio.run(AnswerFile(path, media_type="application/json")(dict(SCOPE), receive, send))
    return messages


def test_it_is_gone_once_it_is_sent(tmp_path: Path) -> None:
    messages = sent(tmp_path / "answer", left=False)
    assert b"".join(message.get("body", b"") for message in messages) == b"answer"
    assert not list(tmp_path.iterdir())


def test_it_is_gone_where_nobody_takes_it(tmp_path: Path) -> None:
    with pytest.raises(OSError, match="left"):
        sent(tmp_path / "answer", left=True)
    assert not list(tmp_path.iterdir())
