"""The stop gate: it accepts every connection and reads its first request. A stop is served here, anything else is
handed to the server, the connection itself with what was read of it.

It needs no disk, and no answer of the server, to stop a rig. It runs in a process of its own (`process`), and in the
server for as long as there is none (`substitute`).
"""

import asyncio
import contextlib
import logging
import socket
import time
from collections import OrderedDict, deque
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from uvicorn.server import ServerState

from fullpose_server.gate import messages
from fullpose_server.gate.app import create_app
from fullpose_server.gate.first_request import FirstRequest, StopOf
from fullpose_server.gate.rigs import Rigs
from fullpose_server.gate.served import Connections, served_by
from fullpose_server.gate.who import Who

ASK_S = 10.0  # so long a connection may take to ask for something
RESERVE = 64  # descriptors that are kept for stops and for what Python needs
SWEEP_S = 0.25
BEAT_S = 0.05
_REST_S = 0.02
_END_S = 1.0  # for open channels to be closed
_READ = 1 << 16
_ACCEPTS = 64  # at once; then what has come is read
_TOLD = 4096  # messages kept for a server that does not keep up
log = logging.getLogger("fullpose.gate")


@dataclass
class Waiting:
    """A connection that has not been given to anybody yet."""

    socket: socket.socket
    since: float
    request: FirstRequest = field(default_factory=FirstRequest)


class Gate:
    """One gate, on the running event loop; of `most` descriptors some are kept free.

    It accepts from when the server has told it something: one in reserve is told nothing until it is needed.
    """

    def __init__(self, listener: socket.socket, link: socket.socket, most: int, proxies: Sequence[str]) -> None:
        self._listener = listener
        self._link = link
        self._most = max(16, most - RESERVE)
        self._loop = asyncio.get_running_loop()
        self._waiting: OrderedDict[int, Waiting] = OrderedDict()  # by descriptor, the oldest first
        self._asked: deque[Waiting] = deque()  # for a server that does not keep up
        self._told: deque[messages.ToServer] = deque(maxlen=_TOLD)
        self._awaited = asyncio.Event()  # the server has told something
        self._accepts = False
        self._ending = False
        self._gone = asyncio.Event()
        self._rigs = Rigs(lambda entry: self._tell(messages.Stopped(entry)))
        self._who = Who()
        app = create_app(self._rigs, self._who)
        config = served_by(app, ws_max_size=messages.MAX_PACKET, forwarded_allow_ips=list(proxies))
        self._served = Connections(config, ServerState())

    async def run(self, beat: Callable[[], None] = lambda: None) -> None:
        """Until the server is gone; `beat` is called as long as this event loop runs."""
        self._loop.add_reader(self._link, self._hear)
        doing = [asyncio.create_task(self._beat_on(beat), name="beat")]
        doing.append(asyncio.create_task(self._sweep(), name="sweep"))
        await self._gone.wait()
        for task in doing:
            task.cancel()
        await asyncio.gather(*doing, return_exceptions=True)
        await self._served.close(_END_S)
        self._rigs.close()

    def retire(self) -> None:
        """Accept no more; what has been accepted is still served."""
        self._accepts = False
        self._loop.remove_reader(self._listener)

    # --- connections ---

    def _accept(self) -> None:
        for _ in range(_ACCEPTS):
            try:
                connection, _ = self._listener.accept()
            except BlockingIOError:
                return
            except OSError:  # no descriptor left, or it is gone before we came
                if not self._drop_oldest():
                    self._rest()
                    return
                continue
            connection.setblocking(False)
            with contextlib.suppress(OSError):
                connection.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
            self._waiting[connection.fileno()] = Waiting(connection, time.monotonic())
            self._loop.add_reader(connection.fileno(), self._read, connection.fileno())
            if len(self._waiting) + len(self._asked) + len(self._served) > self._most:
                self._drop_oldest()

    def _rest(self) -> None:
        """Nothing can be accepted: ask again in a little while, not at once."""
        self._loop.remove_reader(self._listener)
        self._loop.call_later(_REST_S, self._go_on)

    def _go_on(self) -> None:
        if self._accepts:
            self._loop.add_reader(self._listener, self._accept)

    def _drop_oldest(self) -> bool:
        """Make room: for a stop there must be some."""
        if self._waiting:
            _, oldest = self._waiting.popitem(last=False)
            self._loop.remove_reader(oldest.socket.fileno())
        elif self._asked:
            oldest = self._asked.popleft()
        else:
            return False
        oldest.socket.close()
        return True

    def _read(self, descriptor: int) -> None:
        one = self._waiting[descriptor]
        try:
            data = one.socket.recv(_READ)
        except BlockingIOError:
            return
        except OSError:
            data = b""
        wanted = one.request.feed(data) if data else None
        if data and wanted is None:
            return
        del self._waiting[descriptor]
        self._loop.remove_reader(descriptor)
        if wanted is None or (self._ending and not isinstance(wanted, StopOf)):
            one.socket.close()
        elif wanted == StopOf(None) and len(self._served) > self._most // 2:
            one.socket.close()  # channels may not take what a single stop needs
        elif isinstance(wanted, StopOf) and (wanted.rig is None or wanted.rig in self._rigs):
            self._served.serve(one.socket, bytes(one.request.data))
        else:
            self._asked.append(one)
            self._flush()

    async def _beat_on(self, beat: Callable[[], None]) -> None:
        while True:
            beat()
            await asyncio.sleep(BEAT_S)

    async def _sweep(self) -> None:
        await self._awaited.wait()
        while True:
            await asyncio.sleep(SWEEP_S)
            latest = time.monotonic() - ASK_S
            while self._waiting and next(iter(self._waiting.values())).since < latest:
                self._drop_oldest()
            if not self._told:  # which are signs of life too
                self._tell(messages.Alive())

    # --- the server ---

    def _hear(self) -> None:
        try:
            message = messages.for_gate(self._link)
        except BlockingIOError:
            return
        except OSError:
            message = None
        if message is not None and not self._awaited.is_set():
            self._awaited.set()
            self._accepts = True
            self._go_on()
        match message:
            case messages.RigRuns(rig, pid, memory):
                self._rigs.runs(rig, pid, Path(memory))
            case messages.RigLeft(rig):
                self._rigs.left(rig)
            case messages.LetIn():
                self._who.take(message)
            case messages.Ending():
                self._ending = True
            case None:
                self._loop.remove_reader(self._link)
                self.retire()
                for told in self._told:
                    log.warning("not in the audit, for the server has gone: %s", told)
                self._gone.set()

    def _tell(self, message: messages.ToServer) -> None:
        self._told.append(message)
        self._flush()

    def _flush(self) -> None:
        """Hand over what the server has not taken yet, as far as it takes it; later the rest."""
        try:
            while self._told:
                messages.send(self._link, self._told[0])
                self._told.popleft()
            while self._asked:
                messages.pass_on(self._link, self._asked[0].socket, bytes(self._asked[0].request.data))
                self._asked.popleft().socket.close()
        except BlockingIOError:
            self._loop.add_writer(self._link, self._flush)
        except OSError:
            self._loop.remove_writer(self._link)  # it is gone; the reader tells
        else:
            self._loop.remove_writer(self._link)
