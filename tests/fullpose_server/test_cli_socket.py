"""The listening socket: what accepted connections inherit from it."""

import asyncio
import socket

import pytest

from fullpose_server.cli import _serving
from fullpose_server.cli._serving import address, bind


def test_small_answers_are_sent_at_once() -> None:
    """asyncio switches Nagle's algorithm off on what this socket accepts."""

    async def accepted() -> tuple[int, int]:
        options: asyncio.Future[tuple[int, int]] = asyncio.get_running_loop().create_future()

        async def serve(_reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
            inner = writer.get_extra_info("socket")
            nodelay = inner.getsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY)
            unsent = inner.getsockopt(socket.IPPROTO_TCP, socket.TCP_NOTSENT_LOWAT)
            options.set_result((nodelay, unsent))
            writer.close()

        listener = bind("127.0.0.1", 0)
        server = await asyncio.start_server(serve, sock=listener)
        async with server:
            _, writer = await asyncio.open_connection(*listener.getsockname())
            found = await options
            writer.close()
            await writer.wait_closed()
        return found

    nodelay, unsent = asyncio.run(accepted())
    assert nodelay != 0
    assert 0 < unsent <= 65_536


def test_addresses_are_links() -> None:
    for host, text in (("127.0.0.1", "http://127.0.0.1:"), ("0.0.0.0", "http://localhost:"), ("::1", "http://[::1]:")):
        with bind(host, 0) as listener:
            assert address(listener).startswith(text)


def test_a_port_that_becomes_free_is_waited_for(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """What a killed server had started holds it for a moment."""
    holder = bind("127.0.0.1", 0)
    port = holder.getsockname()[1]
    monkeypatch.setattr(_serving.time, "sleep", lambda _: holder.close())
    with bind("127.0.0.1", port) as listener:
        assert listener.getsockname()[1] == port
    assert f"port {port} on 127.0.0.1 was in use: waited" in capsys.readouterr().err


def test_one_that_stays_in_use_is_refused_in_one_line(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(_serving, "FREE_S", 0.0)
    with bind("127.0.0.1", 0) as holder, pytest.raises(SystemExit):
        bind("127.0.0.1", holder.getsockname()[1])
    assert " is in use by another program: stop it, or choose another with --port" in capsys.readouterr().err
