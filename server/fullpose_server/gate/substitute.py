"""The stop gate in the server's own event loop, for as long as there is no process of one."""

import asyncio
import socket
from collections.abc import Sequence

from fullpose_server.gate import messages
from fullpose_server.gate.gate import Gate

_MOST = 256  # descriptors: what is asked meanwhile is answered, and a second later a process has begun


class Substitute:
    """Accepts as soon as it is told something by `link`."""

    def __init__(self, listener: socket.socket, proxies: Sequence[str]) -> None:
        listener.setblocking(False)
        self.link, self._theirs = messages.link()
        self._gate = Gate(listener, self._theirs, _MOST, proxies)
        self._running = asyncio.create_task(self._gate.run(), name="stop gate in the server")

    def retire(self) -> None:
        """Accept no more: another does. What was accepted is served until the end."""
        self._gate.retire()

    async def end(self) -> None:
        """Close what it still has: a stop channel is opened anew, at the gate that is there now."""
        self.link.close()
        await asyncio.gather(self._running, return_exceptions=True)
        self._theirs.close()
