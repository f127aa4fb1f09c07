"""What one tick of a rig's loop costs: processor time [us], flying a plan, following a live source, at rest.

    python -m bench.realtime.tick_cost [--seconds 20] [--rounds 5]

The whole loop with the simulated drive, in this process, on a clock that a tick moves by one period: nothing waits, so
other work on the machine disturbs it little. Each figure is the least of the rounds' means.
"""

import argparse
import gc
import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

from bench.machine import machine
from bench.realtime.operator import write_swing
from fullpose.rig import builtin_rigs
from fullpose_server.drives.simulated import SimulatedDrive, SimulatedOptions
from fullpose_server.runtime.contract import messages
from fullpose_server.runtime.contract.config import RigConfig
from fullpose_server.runtime.contract.shared_memory import Shared
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

RIG = "vertical-4"
PROOF = proof_of("the bench's secret")
LIVE_KEY = "the key of the live source"
PERIOD_NS = 1_000_000


class Source:
    """A datagram link that has a sample for every tick while it is `open`."""

    def __init__(self, clock: MadeUpClock) -> None:
        self._clock = clock
        self._sent = 0
        self.open = False
        self._waiting = False

    def fileno(self) -> int:
        """None."""
        return -1

    def recvfrom(self, size: int, /) -> tuple[bytes, str]:  # noqa: ARG002
        """One sample a tick."""
        self._waiting = self.open and not self._waiting
        if not self._waiting:
            raise BlockingIOError
        self._sent += 1
        sample = encode_sample(Kind.EULER, self._sent, seconds(self._clock), (0.0, 0.0, 0.0), ())
        return sample + digest_of(LIVE_KEY), "source"

    def sendto(self, data: bytes, to: Any, /) -> int:  # noqa: ARG002
        """The reply goes nowhere."""
        return len(data)

    def close(self) -> None:
        """Nothing to close."""


class Bench:
    """One rig's loop, ticked."""

    def __init__(self, folder: Path) -> None:
        rig = builtin_rigs()[RIG]
        self.config = RigConfig(RIG, rig, folder, folder / "runs", min_free_mb=0.0)
        self.clock = MadeUpClock()
        self.source = Source(self.clock)
        self.shared = Shared(folder / "memory", create=True)
        drive = SimulatedDrive(rig, self.config.rate_hz, SimulatedOptions())
        live = LiveSource(rig, self.config.live, 1e-3, (self.source,), lambda: seconds(self.clock))
        self.parts = assemble(self.config, drive, self.shared, live, self.clock)
        leisure = Leisure(self, self.parts.log, self.shared.header, self.config.exit_idle_s, seconds(self.clock))
        self.loop = ControlLoop(self.parts, self._serve, leisure)
        self.sequence = 0
        self.epoch = 0

    def _serve(self, answer: Callable[[messages.Request], messages.Answer]) -> "Bench":
        self.answer = answer
        return self

    def poll(self) -> None:
        """Commands are given between ticks."""

    def close(self) -> None:
        """Nothing to close."""

    def revive(self) -> int | None:
        """The recorder lives."""
        return None

    def lease(self, action: str) -> None:
        """Take or renew it."""
        given = self.answer(messages.Request(0, messages.Op.LEASE, "bench", action=action, proof=PROOF)).lease
        if given is None:
            raise RuntimeError(action)
        self.epoch = given.epoch

    def must(self, command: str, **args: Any) -> None:
        """One command that is to be carried out."""
        self.sequence += 1
        token = LeaseToken(self.epoch, self.sequence, PROOF)
        reply = self.answer(messages.Request(0, messages.Op.COMMAND, "bench", command, args, token, key=LIVE_KEY)).reply
        if not reply.ok:
            raise RuntimeError(f"{command}: {reply}")

    def tick(self) -> None:
        """One period passes."""
        self.clock.now += PERIOD_NS
        self.shared.header["recorder_beat_ns"] = self.shared.header["server_beat_ns"] = self.clock.now
        self.loop.tick(self.clock.now, 0, 0)

    def until(self, state: State) -> None:
        """Tick, the lease kept."""
        while self.parts.machine.state is not state:
            self.lease("renew")
            self.tick()

    def mean_us(self, ticks: int) -> float:
        """Of so many ticks [us of processor time]; the lease is renewed twice a second, as a console does."""
        begun = time.process_time_ns()
        for k in range(ticks):
            if k % 500 == 0:
                self.lease("renew")
            self.tick()
        return (time.process_time_ns() - begun) / ticks / 1e3


def measure(seconds_each: float, rounds: int) -> dict[str, float]:
    """Mean processor time of a tick [us] by what the rig does, the least of the rounds."""
    found: dict[str, float] = {}
    ticks = round(1000 * seconds_each / rounds)

    def best(name: str, bench: Bench) -> None:
        found[name] = min(bench.mean_us(ticks) for _ in range(rounds))

    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        bench = Bench(folder)
        gc.disable()  # as the loop does
        bench.lease("take")
        bench.must("connect")
        plan = write_swing(folder / "plan", bench.config.rig, seconds_each + 20.0)
        bench.must("load", plan_folder=str(plan))
        best("ready, at rest", bench)
        bench.must("arm")
        bench.must("start")
        bench.until(State.RUNNING)
        best("flying a plan", bench)
        bench.must("stop")
        bench.until(State.ARMED)
        bench.must("disarm")
        bench.must("unload")
        bench.must("load", live={"method": "exact"})
        bench.must("arm")
        bench.must("go_live")
        bench.source.open = True
        bench.mean_us(2000)
        best("following a live source", bench)
    return found


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seconds", type=float, default=20.0)
    parser.add_argument("--rounds", type=int, default=5)
    given = parser.parse_args()
    print(machine())
    for name, value in measure(given.seconds, given.rounds).items():
        print(f"tick, {name:28s} {value:8.2f} us")


if __name__ == "__main__":
    main()
