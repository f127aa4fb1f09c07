"""The server's side of the stop gate: starts it, starts it anew where it ends, serves what it passes on, audits."""

import asyncio
import contextlib
import logging
import os
import socket
import subprocess
import sys
import time
from collections import deque
from dataclasses import dataclass

from fullpose_server.api.deps import Services
from fullpose_server.api.problems import MEDIA_TYPE, ApiError
from fullpose_server.gate import messages
from fullpose_server.gate.beat import Beat
from fullpose_server.gate.hanging import end_if_it_hangs
from fullpose_server.gate.served import Connections
from fullpose_server.gate.substitute import Substitute
from fullpose_server.gate.waker import keep_awake
from fullpose_server.logs import LogSettings
from fullpose_server.people.admitted import Admitted
from fullpose_server.processes import START_S
from fullpose_server.runtime.supervisor.running import RunningProcess

RETRY_S = 0.5
SILENT_S = 5.0  # a gate that tells nothing for so long serves nobody: it tells at least every `gate.gate.SWEEP_S`
SPARE_AFTER_S = 5.0  # the one in reserve is made when this one has begun: they would take the processor from each other
_AT_ONCE = 64  # messages; then the event loop has its turn
_END_S = 5.0
log = logging.getLogger(__name__)


@dataclass(frozen=True)
class GateProcess:
    """A gate that was started, and the server's end of the link to it."""

    process: "subprocess.Popen[bytes]"
    link: socket.socket
    beat: Beat
    log: LogSettings
    proxies: tuple[str, ...]

    @classmethod
    def spawn(cls, listener: socket.socket, log: LogSettings, proxies: tuple[str, ...] = ()) -> "GateProcess":
        """Start one: it gets ready, and accepts from when it is told what it may stop and who may."""
        ours, theirs = messages.link()
        beat, memory = Beat.made()
        with theirs, os.fdopen(memory, "rb"):
            named = [word for each in proxies for word in ("--proxy", each)]
            given = {"--listener": listener.fileno(), "--link": theirs.fileno(), "--beat": memory}
            command = [sys.executable, "-m", "fullpose_server.gate.process"]
            command += [word for name, number in given.items() for word in (name, str(number))]
            process = subprocess.Popen(
                [*command, *named, *log.arguments()],
                pass_fds=tuple(given.values()),
                stdin=subprocess.DEVNULL,
                stdout=subprocess.DEVNULL,
            )
        keep_awake(process.pid, "the stop gate")
        end_if_it_hangs(process.pid, beat)
        return cls(process, ours, beat, log, proxies)

    def another(self, listener: socket.socket) -> "GateProcess":
        """As this one was started."""
        return GateProcess.spawn(listener, self.log, self.proxies)

    @property
    def ready(self) -> bool:
        """Whether its event loop runs: it takes over at once."""
        return self.beat.last_ns > 0 and self.process.poll() is None

    async def end(self) -> None:
        """It ends when its link does; one that does not is killed."""
        self.link.close()
        await asyncio.to_thread(self._reap)

    def _reap(self) -> None:
        try:
            self.process.wait(_END_S)
        except subprocess.TimeoutExpired:
            self.process.kill()
            self.process.wait()


class Keeper:
    """Of one server's gate, from construction until `close`; at most `most` connections are served at once.

    Where the gate ends, another that has been got ready takes its place at once; where there is none, the server itself
    until one is. Everything belongs to the event loop's thread.
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
        self._newest = gate  # of which others are spawned
        self._gate: GateProcess | Substitute = gate
        self._spare: GateProcess | None = None
        self._past: list[GateProcess | Substitute] = []  # that are to be ended
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
        self._loop.remove_writer(self._gate.link)
        for gate in [self._gate, *filter(None, [self._spare]), *self._past]:
            self._loop.remove_reader(gate.link)
            await gate.end()
        self._listener.close()

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
            if before and silent and isinstance(self._gate, GateProcess):
                self._lost(f"it has told nothing for {patience_s:g} s")
            while self._past:
                past = self._past.pop()
                self._loop.remove_reader(past.link)
                await past.end()
            self._have_a_spare()

    def _have_a_spare(self) -> None:
        alone = isinstance(self._gate, Substitute)
        if self._spare is not None and self._spare.process.poll() is not None:
            self._past.append(self._spare)
            self._spare = None
        elif self._spare is None:
            if alone or (self._begun and time.monotonic() - self._since > SPARE_AFTER_S):
                self._spare = self._newest = self._newest.another(self._listener)
        elif alone and self._spare.ready:
            spare, self._spare = self._spare, None
            self._replace(spare)

    def _replace(self, gate: GateProcess | Substitute) -> None:
        past, self._gate = self._gate, gate
        self._past.append(past)
        self._loop.remove_writer(past.link)
        if isinstance(past, Substitute):
            past.retire()  # and is heard until its end
        self._status.down_since = None if isinstance(gate, GateProcess) else time.time()
        self._begin()

    def _lost(self, why: str) -> None:
        gate = self._gate
        if isinstance(gate, Substitute):
            return
        log.error("the stop gate, process %d, is replaced: %s", gate.process.pid, why)
        self._loop.remove_reader(gate.link)
        with contextlib.suppress(ProcessLookupError):
            gate.process.kill()
        spare = self._spare
        if spare is None or not spare.ready:
            self._replace(Substitute(self._listener, gate.proxies))
        else:
            self._spare = None
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

    def _hear(self, gate: GateProcess | Substitute) -> None:
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
            if gate is self._gate:
                self._heard, self._begun = time.monotonic(), True
            match message:
                case messages.Passed():
                    self._serve(message)
                case messages.Stopped(entry):
                    self._trail.follow(entry)
                case messages.Alive():
                    pass
                case None:
                    self._loop.remove_reader(gate.link)
                    if gate is self._gate:
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
