"""The server's end of a rig process's control socket: requests out, answers back by number."""

import asyncio
import itertools
from dataclasses import replace

from fullpose_server.runtime.contract import messages
from fullpose_server.runtime.contract.messages import MAX_REQUEST
from fullpose_server.runtime.contract.rig_paths import RigPaths, control_socket
from fullpose_server.runtime.supervisor.errors import RequestTooLargeError, RigUnreachableError


class ControlLink:
    """One connection. Use `open`, then `request`; after `RigUnreachableError` open a new one."""

    def __init__(self) -> None:
        self._socket = control_socket()
        self._waiting: dict[int, asyncio.Future[messages.Answer]] = {}
        self._numbers = itertools.count(1)
        self._sending = asyncio.Lock()
        self._reader: asyncio.Task[None] | None = None
        self.open_for_requests = False

    async def open(self, paths: RigPaths) -> None:
        """Connect. Raises `RigUnreachableError` where nobody listens."""
        try:
            with paths.socket_address("control.sock") as address:
                await asyncio.get_running_loop().sock_connect(self._socket, address)
        except OSError as cause:
            self._socket.close()
            raise RigUnreachableError(f"no rig process listens in {paths.directory} ({cause})") from cause
        self.open_for_requests = True
        self._reader = asyncio.create_task(self._read(), name="rig control reader")

    async def request(self, asked: messages.Request, *, timeout_s: float) -> messages.Answer:
        """Send `asked` under a number of our own, and wait for its answer.

        Raises `RigUnreachableError`; TypeError on args not JSON and `RequestTooLargeError`, before anything is sent.
        """
        if not self.open_for_requests:
            raise RigUnreachableError("the rig process has closed the connection")
        number = next(self._numbers)
        packet = messages.encode(replace(asked, id=number))
        if len(packet) > MAX_REQUEST:
            raise RequestTooLargeError(f"{asked.word}: {len(packet)} bytes, expected at most {MAX_REQUEST}")
        waiting: asyncio.Future[messages.Answer] = asyncio.get_running_loop().create_future()
        self._waiting[number] = waiting
        try:
            async with self._sending:  # one writer at a time: the loop knows one callback a socket
                await asyncio.get_running_loop().sock_sendall(self._socket, packet)
            return await asyncio.wait_for(waiting, timeout_s)
        except TimeoutError as cause:
            raise RigUnreachableError(f"the rig process has not answered within {timeout_s:g} s") from cause
        except OSError as cause:
            raise RigUnreachableError(f"the rig process cannot be reached ({cause})") from cause
        finally:
            self._waiting.pop(number, None)
            if waiting.done() and not waiting.cancelled():
                waiting.exception()  # told above, where it is one

    async def close(self) -> None:
        """Close the connection; waiting requests raise."""
        if self._reader is not None:
            self._reader.cancel()
            await asyncio.gather(self._reader, return_exceptions=True)
        self._end()

    async def _read(self) -> None:
        loop = asyncio.get_running_loop()
        try:
            while packet := await loop.sock_recv(self._socket, 1 << 20):
                answer = messages.decode_answer(packet)
                waiting = self._waiting.get(answer.id)
                if waiting is not None and not waiting.done():
                    waiting.set_result(answer)
        except OSError:
            pass  # the process died: those who wait are told below
        finally:
            self._end()

    def _end(self) -> None:
        self.open_for_requests = False
        self._socket.close()
        for waiting in self._waiting.values():
            if not waiting.done():
                waiting.set_exception(RigUnreachableError("the rig process ended before it answered"))


class StandingLink:
    """The link to whatever process of a rig runs, opened anew where it has broken."""

    def __init__(self, paths: RigPaths) -> None:
        self._paths = paths
        self._link: ControlLink | None = None
        self._opening = asyncio.Lock()

    async def current(self) -> ControlLink:
        """The link, open. Raises `RigUnreachableError`."""
        async with self._opening:
            if self._link is None or not self._link.open_for_requests:
                link = ControlLink()
                await link.open(self._paths)
                if self._link is not None:
                    await self._link.close()
                self._link = link
            return self._link

    async def close(self) -> None:
        """Close it; waiting requests raise. The next `current` opens it anew."""
        if self._link is not None:
            await self._link.close()
