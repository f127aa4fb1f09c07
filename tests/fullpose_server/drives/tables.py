"""Tables behind the udp drive. Imported as `tests.fullpose_server.drives.tables`.

One in this process, whose time a test moves tick by tick; and the emulator, a program of its own.
"""

import contextlib
import select
import socket
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Iterator

from fullpose.rig import Rig
from fullpose_server.drives.base import Drive
from fullpose_server.drives.packet import COMMAND_SIZE, CommandPacket, decode_command, encode_state
from fullpose_server.drives.testing.table_emulator import Table

PATIENCE_S = 60.0


class SteppedTable:
    """A table on a loopback port that does nothing between ticks, but answer the first datagram: somebody connects.

    `loses` tells which commands do not arrive; they are kept in `lost`, and all that do in `passed`.
    """

    def __init__(self, rig: Rig, rate_hz: float, watchdog_s: float) -> None:
        self._made = lambda: Table(rig, rate_hz, watchdog_s)
        self._socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self._socket.bind(("127.0.0.1", 0))
        self.port: int = self._socket.getsockname()[1]
        self.period = 1.0 / rate_hz
        self.loses: Callable[[CommandPacket], bool] = lambda _: False
        self.lost: list[bytes] = []
        self.passed: list[bytes] = []
        self._peer: tuple[str, int] | None = None
        self.restart(time.monotonic())
        self.expect()

    def expect(self) -> None:
        """Answer the next datagram, whenever it comes."""
        self._greeting = threading.Thread(target=self._greet, args=(self.table.advance(self.now),), daemon=True)
        self._greeting.start()

    def _greet(self, state: object) -> None:
        data, self._peer = self._socket.recvfrom(COMMAND_SIZE + 1)
        if data:
            self._socket.sendto(encode_state(state), self._peer)  # type: ignore[arg-type]

    def restart(self, now: float) -> None:
        """Power off and on."""
        self.now = now
        self.table = self._made()
        self.table.begin(now)

    def send(self, data: bytes) -> None:
        """What was lost or has passed comes (again), late."""
        packet = decode_command(data)
        assert packet is not None
        self.table.take(packet)

    def tick(self, now: float) -> None:
        """One period to `now`: take what has come, move, tell."""
        self._greeting.join()
        self.now = now
        while select.select([self._socket], [], [], 0.0)[0]:
            data, self._peer = self._socket.recvfrom(COMMAND_SIZE + 1)
            packet = decode_command(data)
            assert packet is not None
            if self.loses(packet):
                self.lost.append(data)
            else:
                self.passed.append(data)
                self.table.take(packet)
        self.state = self.table.advance(now)
        if self._peer is not None:
            self._socket.sendto(encode_state(self.state), self._peer)

    def close(self) -> None:
        """Let go of the port."""
        if self._greeting.is_alive():  # nobody came
            with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as other:
                other.sendto(b"", ("127.0.0.1", self.port))
            self._greeting.join()
        self._socket.close()


@contextlib.contextmanager
def emulator(*arguments: str) -> Iterator["tuple[int, subprocess.Popen[str]]"]:
    """A running table: its port and process. Ends by itself after ten minutes, whatever happens to the test."""
    program = [sys.executable, "-m", "fullpose_server.drives.testing.table_emulator"]
    process = subprocess.Popen(
        [*program, "--port", "0", "--seconds", "600", *arguments], stdout=subprocess.PIPE, text=True
    )
    assert process.stdout is not None
    try:
        yield int(process.stdout.readline().rsplit(":", 1)[1]), process
    finally:
        process.kill()
        process.wait()
        process.stdout.close()


def heard(drive: Drive) -> None:
    """Wait until something has come from the table that was not read yet."""
    link = drive._socket  # type: ignore[attr-defined]
    if link is not None:
        assert select.select([link], [], [], PATIENCE_S)[0], "the table says nothing"
