"""What a browser would see: viser's wire format, and telemetry samples to feed a scene with."""

import time
from collections.abc import Callable
from typing import Any

import msgspec
import numpy as np
import zstandard
from websockets.sync.client import ClientConnection, unix_connect

from fullpose_server.runtime.contract.rig_paths import SocketAddress
from fullpose_server.runtime.contract.telemetry import SAMPLE
from tests.support.sockets import connect

PATIENCE_S = 20.0


def sample(measured: list[float], demand: list[float] | None = None, target: list[float] | None = None) -> np.void:
    """A telemetry sample as the ring has it [deg]."""
    row = np.zeros(1, dtype=SAMPLE)
    row["measured"] = measured
    row["demand"] = measured if demand is None else demand
    row["target"] = np.nan if target is None else target
    value: np.void = row[0]
    return value


def messages(frame: bytes) -> list[dict[str, Any]]:
    """The messages in one of viser's binary frames."""
    size = int.from_bytes(frame[8:16], "little")
    window = msgspec.msgpack.decode(zstandard.ZstdDecompressor().decompress(frame[16 : 16 + size]))
    return list(window["messages"])


def browser_message(kind: str, **fields: object) -> bytes:
    """A message as viser's page sends it."""
    return msgspec.msgpack.encode({"type": kind, **fields})


CAMERA = browser_message(
    "ViewerCameraMessage",
    wxyz=(1.0, 0.0, 0.0, 0.0),
    position=(1.0, 1.0, 1.0),
    fov=1.0,
    near=0.1,
    far=10.0,
    image_height=480,
    image_width=640,
    look_at=(0.0, 0.0, 0.0),
    up_direction=(0.0, 1.0, 0.0),
)


class Viewer:
    """A WebSocket client of viser that keeps what it was told last of every node."""

    def __init__(self, address: str | SocketAddress) -> None:
        """At the server's address, or at a scene's own socket."""
        self.socket: ClientConnection
        if isinstance(address, str):
            self.socket = connect(address, subprotocols=[subprotocol()], compression=None)
        else:
            with address as path:
                self.socket = unix_connect(path, subprotocols=[subprotocol()], max_size=None, compression=None)
        self.nodes: dict[str, dict[str, Any]] = {}
        self.frames = 0

    def __enter__(self) -> "Viewer":
        return self

    def __exit__(self, *_: object) -> None:
        self.socket.close()

    def until(self, met: Callable[["Viewer"], bool], patience: float = PATIENCE_S) -> None:
        """Read until `met`; fails after `patience` [s]."""
        end = time.monotonic() + patience
        while not met(self):
            assert time.monotonic() < end, f"not seen in {patience} s; nodes: {sorted(self.nodes)}"
            self.read(1.0)

    def read(self, patience: float) -> bool:
        """Take one frame, if one comes within `patience` [s]."""
        try:
            frame = self.socket.recv(timeout=patience)
        except TimeoutError:
            return False
        assert isinstance(frame, bytes)
        self.frames += 1
        for message in messages(frame):
            if "name" in message and isinstance(message["name"], str):
                node = self.nodes.setdefault(message["name"], {})
                node.update({key: value for key, value in message.items() if key not in ("name", "type")})
        return True

    def quaternion(self, *path: str) -> np.ndarray:
        """The orientation of the node at the end of `path`, all its parents' applied: (3, 3) to the reference."""
        turned = np.eye(3)
        for end in range(1, len(path) + 1):
            w, x, y, z = self.nodes["/" + "/".join(path[:end])].get("wxyz", (1.0, 0.0, 0.0, 0.0))
            turned = turned @ np.array(
                [
                    [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
                    [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
                    [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
                ]
            )
        return turned


def subprotocol() -> Any:
    import viser

    return f"viser-v{viser.__version__}"
