"""The server's side of the stop gate: starts it, starts it anew where it ends, serves what it passes on, audits."""

import asyncio
import contextlib
import logging
import socket
import subprocess
import sys
import time
from collections import deque
from dataclasses import dataclass

from fullpose_server.api.deps import Services
from fullpose_server.api.problems import MEDIA_TYPE, ApiError
from fullpose_server.gate import messages
from fullpose_server.gate.served import Connections
from fullpose_server.gate.waker import keep_awake
from fullpose_server.logs import LogSettings
from fullpose_server.people.admitted import Admitted
from fullpose_server.processes import START_S
from fullpose_server.runtime.supervisor.running import RunningProcess

RETRY_S = 0.5
SILENT_S = 5.0  # a gate that tells nothing for so long serves nobody: it tells at least every `gate.process.SWEEP_S`
SPARE_AFTER_S = 5.0  # the one in reserve is made when this one has begun: they would take the processor from each other
_AT_ONCE = 64  # messages; then the event loop has its turn
_END_S = 5.0
log = logging.getLogger(__name__)


@dataclass(frozen=True)
class GateProcess:
    """A gate that was started, and the server's end of the link to it."""

    process: "subprocess.Popen[bytes]"
    link: socket.socket
    log: LogSettings
    proxies: tuple[str, ...]

    @classmethod
    def spawn(cls, listener: socket.socket, log: LogSettings, proxies: tuple[str, ...] = ()) -> "GateProcess":
        """Start one: it gets ready, and accepts from when it is told what it may stop and who may."""
        ours, theirs = messages.link()
        with theirs:
            named = [word for each in proxies for word in ("--proxy", each)]
            numbers = [str(listener.fileno()), str(theirs.fileno())]
            command = [sys.executable, "-m", "fullpose_server.gate.process"]
            process = subprocess.Popen(
                [*command, "--listener", numbers[0], "--link", numbers[1], *named, *log.arguments()],
                pass_fds=(listener.fileno(), theirs.fileno()),
                stdin=subprocess.DEVNULL,
                stdout=subprocess.DEVNULL,
            )
        keep_awake(process.pid, "the stop gate")
        return cls(process, ours, log, proxies)

    def end(self) -> None:
        """It ends when its link does; one that does not is killed."""
        self.link.close()
        try:
            self.process.wait(_END_S)
        except subprocess.TimeoutExpired:
            self.process.kill()
            self.process.wait()


class Keeper:
    """Of one server's gate, from construction until `close`; at most `most` connections are served at once.

    Where the gate ends, another that has been got ready takes its place at once. Everything belongs to the event loop's
    thread.
    """

    def __init__(
        self,
        listener: socket.socket,
        gate: GateProcess,
        served: Connections,
        most: int,
        services: Services,
    ) -> None:
        self._listener = listener
        self._served = served
        self._most = most
        self._running = services.hosts.running
        self._people = services.people
        self._trail = services.trail
        self._status = services.front
        self._loop = asyncio.get_running_loop()
        self._ending = False
        self._gate = gate
        self._spare: GateProcess | None = None
        self._past: list[GateProcess] = []  # that are to be ended
        self._heard = self._since = time.monotonic()
        self._begun = False  # it has told something
        self._untold: deque[messages.ToGate] = deque()
        self._running.watch(self._changed)
        self._begin()
        self._people.watch(self._let_in)
        self._watch = asyncio.create_task(self._watch_on(), name="watch the stop gate")

    def ending(self) -> None:
        """From here on nothing but stops is served."""
        self._ending = True
        self._send(messages.Ending())

    async def close(self) -> None:
        """End the gate."""
        self._watch.cancel()
        await asyncio.gather(self._watch, return_exceptions=True)
        self._loop.remove_reader(self._gate.link)
        self._loop.remove_writer(self._gate.link)
        self._listener.close()
        for gate in [self._gate, *filter(None, [self._spare]), *self._past]:
            await asyncio.to_thread(gate.end)

    # --- the gate's life ---

    def _begin(self) -> None:
        self._heard = self._since = time.monotonic()
        self._begun = False
        self._untold.clear()
        self._loop.add_reader(self._gate.link, self._hear, self._gate)
        for process in self._running.all():
            self._changed(process.rig, process)
        self._let_in(self._people.may_stop)
        if self._ending:
            self.ending()

    async def _watch_on(self) -> None:
        silent = False  # seen so once before: a server that was itself suspended reads first what has come meanwhile
        while True:
            await asyncio.sleep(RETRY_S)
            patience_s = SILENT_S if self._begun else START_S
            before, silent = silent, time.monotonic() - self._heard > patience_s
            if before and silent and self._status.down_since is None:
                self._lost(f"it has told nothing for {patience_s:g} s")
            if self._status.down_since is not None:
                self._replace(self._spawned())
            while self._past:
                await asyncio.to_thread(self._past.pop().end)
            if self._spare is not None and self._spare.process.poll() is not None:
                self._past.append(self._spare)
                self._spare = None
            elif self._spare is None and self._begun and time.monotonic() - self._since > SPARE_AFTER_S:
                self._spare = self._spawned()

    def _spawned(self) -> GateProcess:
        return GateProcess.spawn(self._listener, self._gate.log, self._gate.proxies)

    def _replace(self, gate: GateProcess) -> None:
        self._past.append(self._gate)
        self._gate = gate
        self._status.down_since = None
        self._begin()

    def _lost(self, why: str) -> None:
        if self._status.down_since is None:
            log.error("the stop gate, process %d, is replaced: %s", self._gate.process.pid, why)
            self._status.down_since = time.time()
            self._loop.remove_reader(self._gate.link)
            self._loop.remove_writer(self._gate.link)
            with contextlib.suppress(ProcessLookupError):
                self._gate.process.kill()
            spare, self._spare = self._spare, None
            if spare is not None:
                self._replace(spare)

    def _changed(self, rig: str, process: RunningProcess | None) -> None:
        if process is None:
            self._send(messages.RigLeft(rig))
        else:
            self._send(messages.RigRuns(rig, process.pid, str(process.memory)))

    def _let_in(self, admitted: Admitted) -> None:
        newer = messages.let_in(admitted)  # it replaces what the gate has heard a part of, too
        self._untold = deque([*(each for each in self._untold if not isinstance(each, messages.LetIn)), *newer])
        self._flush()

    def _send(self, message: messages.ToGate) -> None:
        self._untold.append(message)
        self._flush()

    def _flush(self) -> None:
        """Tell what is to be told, as far as the gate takes it; later the rest."""
        if self._status.down_since is not None:
            return  # a new one is told all of it
        link = self._gate.link
        try:
            while self._untold:
                messages.send(link, self._untold[0])
                self._untold.popleft()
        except BlockingIOError:
            self._loop.add_writer(link, self._flush)  # a gate that never takes it is silent too, and replaced for that
        except OSError as cause:
            self._lost(f"it takes no message ({cause})")
        else:
            self._loop.remove_writer(link)

    # --- what it says ---

    def _hear(self, gate: GateProcess) -> None:
        for _ in range(_AT_ONCE):
            try:
                message = messages.for_server(gate.link)
            except BlockingIOError:
                return
            except messages.NoDescriptorError as lost:
                log.warning("%s", lost)
                continue
            except OSError:
                message = None
            self._heard, self._begun = time.monotonic(), True
            match message:
                case messages.Passed():
                    self._serve(message)
                case messages.Stopped(entry):
                    self._trail.follow(entry)
                case messages.Alive():
                    pass
                case None:
                    self._lost("it has ended")
                    return

    def _serve(self, passed: messages.Passed) -> None:
        if len(self._served) < self._most:
            self._served.serve(passed.socket, passed.data)
            return
        with passed.socket, contextlib.suppress(OSError):
            passed.socket.setblocking(False)
            passed.socket.send(_FULL)


def _full() -> bytes:
    """The answer, as bytes: no more is spent on a connection that cannot be served."""
    told = ApiError(503, "busy", "the server has as many connections as it may: close some, or try again later")
    body = told.problem.model_dump_json(exclude_none=True).encode()
    head = f"HTTP/1.1 503 Service Unavailable\r\ncontent-type: {MEDIA_TYPE}\r\ncontent-length: {len(body)}\r\n"
    return head.encode() + b"retry-after: 1\r\nconnection: close\r\n\r\n" + body


_FULL = _full()
