"""From the E-stop request, over HTTP and over the stream's WebSocket, to the first braking command.

    python -m bench.realtime.estop_latency [--times 100] [--viewers 200]

The rig moves. The clock starts before the request is sent, over HTTP before the connection is opened, and ends when
the loop has written the first braking command to the drive (the loop notes the time in shared memory). The same for
the flag alone, from this process.
"""

import argparse
import asyncio
import contextlib
import http.client
import tempfile
import threading
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np

from bench.machine import machine
from bench.realtime.operator import Operator, attached, write_swing
from bench.realtime.rig_load import Viewer, loaded, served
from fullpose.rig import builtin_rigs
from fullpose_server.gate.system import SERVER, before_others
from fullpose_server.runtime.supervisor.rig_client import RigHost

RIG = "vertical-4"


def ask(port: int, word: str = "estop") -> None:
    """Request the E-stop, or a stop, over HTTP, connecting included, and wait for the answer."""
    link = http.client.HTTPConnection("127.0.0.1", port, timeout=10)
    link.request("POST", f"/api/v1/rigs/{RIG}/{word}", b"")
    answer = link.getresponse()
    body = answer.read()
    link.close()
    assert answer.status == 200, body


class OpenStream:
    """A stream that a console has open all the time, and reads all the time."""

    def __init__(self, port: int) -> None:
        self._viewer = Viewer(port, RIG)
        self._viewer.link.setblocking(True)
        threading.Thread(target=self._read, daemon=True).start()

    def _read(self) -> None:
        with contextlib.suppress(OSError):
            while self._viewer.read():
                pass

    def ask(self) -> None:
        """Request the E-stop over it."""
        self._viewer.send(b'{"type":"estop"}')


async def stop_once(host: RigHost, plan: Path, over: Callable[[], None], sign: float) -> float:
    """Milliseconds from the request to the first braking command, in the middle of a move."""
    operator = Operator(host)
    await operator.arm(plan_folder=str(plan))
    pose = host.snapshot().pose_deg
    await operator.must("move", target_deg=[v + sign * 300.0 for v in pose])
    await asyncio.sleep(0.4)
    shared = host.memory
    asked = await asyncio.to_thread(_asked, over)
    await operator.until("estopped")
    await asyncio.sleep(0.05)
    wrote = int(shared.header["estop_wrote_ns"][0])
    assert wrote >= asked, "the rig was not moving"
    taken = (wrote - asked) / 1e6
    await asyncio.sleep(0.3)
    await operator.recover()
    return taken


def _asked(over: Callable[[], None]) -> int:
    before_others(SERVER)  # this thread, as the server: measured is that one, not who asks
    asked = time.monotonic_ns()
    over()
    return asked


def row(name: str, values: list[float]) -> str:
    """One line of the table."""
    p50, p99 = np.percentile(values, [50, 99])
    return f"{name:44s} {p50:8.2f} {p99:8.2f} {max(values):8.2f} {len(values):6d}"


async def measure(times: int, viewers: int) -> None:
    """The table."""
    rig = builtin_rigs()[RIG]
    with tempfile.TemporaryDirectory() as folder:
        root = Path(folder)
        plan = write_swing(root / "plan", rig, 1.0)
        print(machine())
        print(f"{'request to first braking command [ms]':44s} {'p50':>8s} {'p99':>8s} {'max':>8s} {'times':>6s}")
        with served(root / "data") as (port, _):
            host = await attached(port, root / "data", rig)
            for name, count in (("", 0), (f", {viewers} viewers, uploads, planning", viewers)):
                span = 12.0 * times + 30.0
                with loaded(port, RIG, count, span, upload=bool(count), plan=bool(count)):
                    await asyncio.sleep(5.0 if count else 0.0)
                    ways: dict[str, Callable[[], Callable[[], None]]] = {
                        "flag": lambda: lambda: host.estop("bench"),
                        "HTTP": lambda: lambda: ask(port),
                        "WebSocket": lambda: OpenStream(port).ask,
                    }
                    for way, make in ways.items():
                        over = make()
                        taken = [await stop_once(host, plan, over, (-1.0) ** k) for k in range(times)]
                        print(row(way + name, taken), flush=True)
            await host.close(stop_rig=False)


def main() -> None:
    """Print the table."""
    arguments = argparse.ArgumentParser(description=__doc__)
    arguments.add_argument("--times", type=int, default=100)
    arguments.add_argument("--viewers", type=int, default=200)
    given = arguments.parse_args()
    asyncio.run(measure(given.times, given.viewers))


if __name__ == "__main__":
    main()
