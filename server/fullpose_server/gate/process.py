"""The stop gate, `python -m fullpose_server.gate.process --listener FD --link FD`: started by the server, ends with it.

It accepts every connection and reads its first request: a stop is served here, anything else is handed to the server,
the connection itself with what was read of it. It needs no disk, and no answer of the server, to stop a rig.
"""

import argparse
import asyncio
import contextlib
import logging
import select
import signal
import socket
import time
from collections import OrderedDict, deque
from dataclasses import dataclass, field
from pathlib import Path

from uvicorn.server import ServerState

from fullpose_server.gate import messages
from fullpose_server.gate.app import create_app
from fullpose_server.gate.first_request import FirstRequest, StopOf
from fullpose_server.gate.rigs import Rigs
from fullpose_server.gate.served import Connections, served_by
from fullpose_server.gate.system import GATE, before_others, files
from fullpose_server.gate.who import Who
from fullpose_server.logs import LogFormat, LogLevel, LogSettings, configure

ASK_S = 10.0  # so long a connection may take to ask for something
RESERVE = 64  # descriptors that are kept for stops and for what Python needs
SWEEP_S = 0.25
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
    """One gate, on an event loop of its own."""

    def __init__(self, listener: socket.socket, link: socket.socket, most: int, proxies: list[str]) -> None:
        self._listener = listener
        self._link = link
        self._most = max(16, most - RESERVE)
        self._loop = asyncio.get_running_loop()
        self._waiting: OrderedDict[int, Waiting] = OrderedDict()  # by descriptor, the oldest first
        self._asked: deque[Waiting] = deque()  # for a server that does not keep up
        self._told: deque[messages.ToServer] = deque(maxlen=_TOLD)
        self._ending = False
        self._gone = asyncio.Event()
        self._rigs = Rigs(lambda entry: self._tell(messages.Stopped(entry)))
        self._who = Who()
        app = create_app(self._rigs, self._who)
        config = served_by(app, ws_max_size=messages.MAX_PACKET, forwarded_allow_ips=proxies)
        self._served = Connections(config, ServerState())

    async def run(self) -> None:
        """Until the server is gone."""
        self._loop.add_reader(self._link, self._hear)
        self._loop.add_reader(self._listener, self._accept)
        sweeping = asyncio.create_task(self._sweep(), name="sweep")
        await self._gone.wait()
        sweeping.cancel()
        await asyncio.gather(sweeping, return_exceptions=True)
        await self._served.close(_END_S)

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
        self._loop.call_later(_REST_S, self._loop.add_reader, self._listener, self._accept)

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

    async def _sweep(self) -> None:
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
                self._loop.remove_reader(self._listener)
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


def main() -> None:
    """Run until the server is gone."""
    arguments = argparse.ArgumentParser(description="The stop gate of one server.")
    arguments.add_argument("--listener", type=int, required=True)
    arguments.add_argument("--link", type=int, required=True)
    arguments.add_argument("--proxy", action="append", default=[], help="who may say for whom they ask")
    arguments.add_argument("--log-format", type=LogFormat, required=True)
    arguments.add_argument("--log-level", type=LogLevel, required=True)
    given = arguments.parse_args()
    configure(LogSettings(given.log_format, given.log_level))
    # A rig that brakes while the server ends, or that flies while Ctrl-Z suspends it, can still be stopped.
    for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP, signal.SIGTSTP):
        signal.signal(number, signal.SIG_IGN)
    before_others(GATE)
    listener, link = socket.socket(fileno=given.listener), socket.socket(fileno=given.link)
    listener.setblocking(False)
    select.select([link], [], [])  # one in reserve is told nothing until it is needed

    async def gate() -> None:
        await Gate(listener, link, files(), given.proxy).run()

    asyncio.run(gate())


if __name__ == "__main__":
    main()
