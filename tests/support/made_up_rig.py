"""One rig's whole loop on a made-up clock: the simulated table, no process, no socket, no sleep."""

import os
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from fullpose.rig import Rig
from fullpose_server.drives.simulated import SimulatedDrive, SimulatedOptions
from fullpose_server.runtime.contract import messages
from fullpose_server.runtime.contract.config import RigConfig
from fullpose_server.runtime.contract.shared_memory import Shared
from fullpose_server.runtime.contract.telemetry import Samples
from fullpose_server.runtime.live.packets import Kind, encode_sample
from fullpose_server.runtime.live.provenance import digest_of
from fullpose_server.runtime.live.source import LiveSource
from fullpose_server.runtime.loop.clock import MadeUpClock, seconds
from fullpose_server.runtime.loop.control_loop import ControlLoop
from fullpose_server.runtime.loop.leisure import Leisure
from fullpose_server.runtime.loop.process import assemble
from fullpose_server.secret import proof_of
from fullpose_server.session.lease import LeaseToken
from fullpose_server.session.states import State

PROOF = proof_of("anna's secret")
LIVE_KEY = "the key of the live source"


class Link:
    """A datagram socket in memory."""

    def __init__(self) -> None:
        self.waiting: list[tuple[bytes, str]] = []  # datagrams and their senders
        self.replies: list[tuple[bytes, str]] = []  # and their receivers

    def fileno(self) -> int:
        return -1

    def recvfrom(self, size: int, /) -> tuple[bytes, str]:
        if not self.waiting:
            raise BlockingIOError
        data, sender = self.waiting.pop(0)
        return data[:size], sender

    def sendto(self, data: bytes, to: Any, /) -> int:
        self.replies.append((data, to))
        return len(data)

    def close(self) -> None:
        pass


class Recorder:
    """One that lives, until its process is said to have ended; the next is this test's own."""

    pid = os.getpid()

    def revive(self) -> int | None:
        if self.pid == os.getpid():
            return None
        self.pid = os.getpid()
        return self.pid


def level(k: int, t: float) -> bytes:
    """A sample that stands still."""
    return encode_sample(Kind.EULER, k, t, (0.0, 0.0, 0.0), ())


class MadeUpRig:
    """Ticks the loop; by default the server, the recorder and the operator are heard all the time.

    `source` makes the sample of each tick while the session is live, from its number and its time [s] after the first.
    """

    def __init__(self, config: RigConfig, memory: Path, options: SimulatedOptions | None = None) -> None:
        self.clock = MadeUpClock()
        self.shared = Shared(memory, create=True)
        self.link = Link()
        self.drive = SimulatedDrive(config.rig, config.rate_hz, options or SimulatedOptions())
        live = LiveSource(config.rig, config.live, 1.0 / config.rate_hz, (self.link,), lambda: seconds(self.clock))
        self.parts = assemble(config, self.drive, self.shared, live, self.clock)
        self.recorder = Recorder()
        leisure = Leisure(self.recorder, self.parts.log, self.shared.header, config.exit_idle_s, seconds(self.clock))
        self.loop = ControlLoop(self.parts, self._serve, leisure)
        self.period_ns = round(1e9 / config.rate_hz)
        self.server_heard = self.owner_heard = self.source_heard = True
        self.source: Callable[[int, float], bytes] = level
        self.number = self.epoch = self.sequence = self.sent = 0
        self.config = config
        self.missed = 0

    def _serve(self, answer: Callable[[messages.Request], messages.Answer]) -> "MadeUpRig":
        self.answer = answer
        return self

    def poll(self) -> None:
        """Requests are made by `say`, between ticks."""

    def close(self) -> None:
        pass

    @property
    def rig(self) -> Rig:
        return self.config.rig

    @property
    def rate_hz(self) -> float:
        return self.config.rate_hz

    @property
    def state(self) -> State:
        return self.parts.machine.state

    def codes(self) -> list[str]:
        return [alarm.code for alarm in self.parts.machine.alarms.history]

    def speed(self) -> float:
        """The fastest frame's measured rate [rad/s]."""
        return float(abs(self.parts.state.measured_rate).max())

    def ask(self, op: messages.Op, command: str, args: dict[str, Any], action: str = "") -> messages.Answer:
        self.number += 1
        token = LeaseToken(self.epoch, self.sequence, PROOF)
        asked = messages.Request(self.number, op, "anna", command, args, token, action, None, PROOF, LIVE_KEY)
        return self.answer(asked)

    def take(self) -> None:
        lease = self.ask(messages.Op.LEASE, "", {}, "take").lease
        assert lease is not None
        self.epoch = lease.epoch
        self.sequence = 0

    def say(self, command: str, **args: Any) -> messages.Reply:
        self.sequence += 1
        return self.ask(messages.Op.COMMAND, command, args).reply

    def must(self, command: str, **args: Any) -> None:
        reply = self.say(command, **args)
        assert reply.ok, reply

    def ready(self, **load: Any) -> None:
        """From its beginning to ready with what `load` says."""
        self.take()
        self.tick()
        self.must("connect")
        self.tick()
        self.must("load", **load)
        self.tick()

    def rows(self) -> Samples:
        """The telemetry that the ring still has."""
        return self.shared.ring.since(0, 1 << 20)[0]

    def tick(self) -> None:
        """One period passes."""
        self.clock.now += self.period_ns * (1 + self.missed)
        header = self.shared.header
        header["recorder_beat_ns"] = self.clock.now
        header["recorder_pid"] = self.recorder.pid
        if self.server_heard:
            header["server_beat_ns"] = self.clock.now
        if self.owner_heard and self.epoch and self.parts.state.ticks % 50 == 0:
            self.ask(messages.Op.LEASE, "", {}, "renew")
        if self.source_heard and self.state is State.LIVE:
            sample = self.source(self.sent, self.sent / self.config.rate_hz)
            self.link.waiting.append((sample + digest_of(LIVE_KEY), "source"))
            self.sent += 1
        self.loop.tick(self.clock.now, 0, self.missed)

    def run(self, for_s: float) -> None:
        for _ in range(round(for_s * self.config.rate_hz)):
            self.tick()

    def until(self, *states: State, within_s: float = 60.0) -> None:
        for _ in range(round(within_s * self.config.rate_hz)):
            if self.state in states:
                return
            self.tick()
        raise AssertionError(f"still {self.state}: {self.codes()}")


@contextmanager
def made_up_rig(config: RigConfig, options: SimulatedOptions | None = None) -> Iterator[MadeUpRig]:
    """A rig under the folder of `config`."""
    config.directory.mkdir(parents=True, exist_ok=True)
    yield MadeUpRig(config, config.directory / "memory", options)
