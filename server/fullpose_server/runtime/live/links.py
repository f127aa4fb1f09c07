"""The sockets that a live source's samples come by: a local one that the server pushes through, and UDP."""

import os
import socket

from fullpose_server.runtime.contract.config import LiveConfig
from fullpose_server.runtime.contract.rig_paths import RigPaths


def open_links(paths: RigPaths, config: LiveConfig) -> tuple[socket.socket, ...]:
    """Bind them, non-blocking. Raises OSError."""
    local = socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM | socket.SOCK_CLOEXEC)
    with paths.socket_address("live.sock") as address:
        (paths.directory / "live.sock").unlink(missing_ok=True)
        local.bind(address)
    os.chmod(paths.directory / "live.sock", 0o600)  # noqa: PTH101
    opened = [local]
    if config.udp_port is not None:
        udp = socket.socket(socket.AF_INET, socket.SOCK_DGRAM | socket.SOCK_CLOEXEC)
        udp.bind((config.udp_host, config.udp_port))
        opened.append(udp)
    for each in opened:
        each.setblocking(False)
    return tuple(opened)
