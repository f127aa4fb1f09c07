"""A bad network between the udp drive and a table. Imported as `tests.fullpose_server.drives.relay`."""

import contextlib
import select
import socket
import threading
from collections.abc import Callable, Iterator

from fullpose_server.drives.packet import COMMAND_SIZE, STATE_SIZE, CommandPacket, decode_command


class Relay:
    """Passes datagrams on, on its own thread. Set `loses` for commands that do not arrive; they are kept in `lost`."""

    def __init__(self, table_port: int) -> None:
        self._front = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self._front.bind(("127.0.0.1", 0))
        self._back = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self._back.connect(("127.0.0.1", table_port))
        for end in (self._front, self._back):
            end.setblocking(False)
        self.port: int = self._front.getsockname()[1]
        self.loses: Callable[[CommandPacket], bool] = lambda _: False
        self.loses_state: Callable[[], bool] = lambda: False
        self.lost: list[bytes] = []
        self.passed: list[bytes] = []  # orders only: demands are too many
        self._peer: tuple[str, int] | None = None
        self._ended = threading.Event()
        self._thread = threading.Thread(target=self._run, daemon=True)
        self._thread.start()

    def send(self, data: bytes) -> None:
        """What was lost or has passed comes (again), late."""
        self._back.send(data)

    def close(self) -> None:
        """End the thread."""
        self._ended.set()
        self._thread.join()
        self._front.close()
        self._back.close()

    def _run(self) -> None:
        while not self._ended.is_set():
            ready, _, _ = select.select([self._front, self._back], [], [], 0.05)
            with contextlib.suppress(OSError):
                if self._front in ready:
                    self._command(*self._front.recvfrom(COMMAND_SIZE + 1))
            with contextlib.suppress(OSError):
                if self._back in ready:
                    state = self._back.recv(STATE_SIZE + 1)
                    if self._peer is not None and not self.loses_state():
                        self._front.sendto(state, self._peer)

    def _command(self, data: bytes, sender: tuple[str, int]) -> None:
        self._peer = sender
        command = decode_command(data)
        assert command is not None
        if self.loses(command):
            self.lost.append(data)
            return
        if command.sequence == 0:
            self.passed.append(data)
        self._back.send(data)


@contextlib.contextmanager
def relay(table_port: int) -> Iterator[Relay]:
    """A running relay before the table."""
    made = Relay(table_port)
    try:
        yield made
    finally:
        made.close()
