"""The server's end of the control socket, against the rig process's own."""

import asyncio
import contextlib
from collections.abc import AsyncIterator
from pathlib import Path
from typing import Any

import pytest

from fullpose_server.runtime.contract import messages
from fullpose_server.runtime.contract.messages import MAX_REQUEST, Op
from fullpose_server.runtime.contract.rig_paths import RigPaths
from fullpose_server.runtime.loop.control_server import ControlServer
from fullpose_server.runtime.supervisor.control_link import ControlLink
from fullpose_server.runtime.supervisor.errors import RequestTooLargeError

PATIENCE_S = 60.0


@contextlib.asynccontextmanager
async def linked(folder: Path) -> AsyncIterator[tuple[ControlLink, list[messages.Request]]]:
    """A link to a polled server that says yes to everything, and what that server was asked."""
    asked: list[messages.Request] = []

    def answer(request: messages.Request) -> messages.Answer:
        asked.append(request)
        return messages.Answer(request.id, messages.Reply(True, "idle", "idle", 0))

    loop = asyncio.get_running_loop()

    def poll() -> None:
        nonlocal polling
        server.poll()
        polling = loop.call_later(0.001, poll)

    paths = RigPaths(folder)
    server = ControlServer(paths, answer)
    polling: asyncio.Handle = loop.call_soon(poll)
    link = ControlLink()
    try:
        await link.open(paths)
        yield link, asked
    finally:
        await link.close()
        polling.cancel()
        server.close()


def filled(number: int, size: int) -> dict[str, Any]:
    """Arguments with which `load`, as request `number`, takes `size` bytes."""
    empty = messages.encode(messages.Request(number, Op.COMMAND, "ann", "load", {"live": ""}))
    return {"live": "x" * (size - len(empty))}


async def load(link: ControlLink, args: dict[str, Any]) -> messages.Answer:
    return await link.request(messages.Request(0, Op.COMMAND, "ann", "load", args), timeout_s=PATIENCE_S)


def test_a_request_of_the_greatest_size_is_read_whole(tmp_path: Path) -> None:
    async def ask() -> None:
        async with linked(tmp_path) as (link, asked):
            args = filled(1, MAX_REQUEST)
            assert (await load(link, args)).reply.ok
            assert [request.args for request in asked] == [args]

    asyncio.run(ask())


def test_a_larger_request_is_refused_before_it_is_sent_and_the_link_stands(tmp_path: Path) -> None:
    async def ask() -> None:
        async with linked(tmp_path) as (link, asked):
            with pytest.raises(RequestTooLargeError, match=f"load: {MAX_REQUEST + 1} bytes, .* at most {MAX_REQUEST}"):
                await load(link, filled(1, MAX_REQUEST + 1))
            assert link.open_for_requests
            assert (await load(link, {})).reply.ok
            assert [request.args for request in asked] == [{}]

    asyncio.run(ask())
