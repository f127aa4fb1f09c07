"""Where a rig process can be found: lock, notes, socket and shared memory, and whether one is alive.

The lock is held for as long as the process lives, so that a file left behind by a crash is never taken for a rig.
"""

import fcntl
import hashlib
import json
import os
import socket
from pathlib import Path

from fullpose_server.runtime.contract.shared_memory import shared_directory


class RigPaths:
    """The files of one rig in `directory`."""

    def __init__(self, directory: Path) -> None:
        self.directory = directory
        self.config = directory / "config.json"
        self.notes = directory / "process.json"
        self.log = directory / "rig.log"
        self.lock = directory / "rig.lock"

    def memory(self) -> Path:
        """Of the shared memory: named after the directory, so that two data folders never meet."""
        name = hashlib.sha256(str(self.directory.resolve()).encode()).hexdigest()[:20]
        parent = shared_directory()
        return self.directory / "telemetry.ring" if parent is None else parent / f"fullpose-{os.getuid()}-{name}"

    def prepare(self) -> None:
        """Make the directory, for the owner alone."""
        self.directory.mkdir(parents=True, exist_ok=True, mode=0o700)

    def take_lock(self) -> int | None:
        """Take the lock for the life of this process: a file descriptor, or None where another process has it."""
        fd = os.open(self.lock, os.O_RDWR | os.O_CREAT | os.O_CLOEXEC, 0o600)
        try:
            fcntl.flock(fd, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            os.close(fd)
            return None
        return fd

    def held(self) -> bool:
        """Whether a process has the lock: it is the rig's, ready or not."""
        fd = self.take_lock() if self.lock.exists() else None
        if fd is not None:
            os.close(fd)
            return False
        return self.lock.exists()

    def running(self) -> int | None:
        """The pid of the rig process that holds the lock and is ready; None where there is none."""
        if not self.held():
            return None
        try:
            return int(json.loads(self.notes.read_text("utf-8"))["pid"])
        except (OSError, ValueError, KeyError):
            return None

    def write_notes(self, pid: int) -> None:
        """Say that the process is ready."""
        draft = self.notes.with_suffix(".tmp")
        draft.write_text(json.dumps({"pid": pid}), "utf-8")
        draft.replace(self.notes)

    def socket_address(self, name: str) -> "SocketAddress":
        """The address of the Unix socket `name` here."""
        return SocketAddress(self.directory, name)


class SocketAddress:
    """A Unix socket's path through a descriptor of its folder: socket paths may not exceed 107 bytes, folders do.

    Use as a context manager: the address is valid inside.
    """

    def __init__(self, directory: Path, name: str) -> None:
        self._directory = directory
        self._name = name
        self._fd = -1

    def __enter__(self) -> str:
        self._fd = os.open(self._directory, os.O_PATH | os.O_CLOEXEC)
        return f"/proc/self/fd/{self._fd}/{self._name}"

    def __exit__(self, *_: object) -> None:
        os.close(self._fd)


def control_socket() -> socket.socket:
    """A socket of the kind that server and rig process speak over: packets, in order, non-blocking."""
    made = socket.socket(socket.AF_UNIX, socket.SOCK_SEQPACKET | socket.SOCK_CLOEXEC)
    made.setblocking(False)
    return made
