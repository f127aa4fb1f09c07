"""The listening socket: what accepted connections inherit from it."""

import asyncio
import socket

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
