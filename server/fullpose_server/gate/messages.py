"""What the server and the stop gate say to each other: one packet each, JSON, or a connection that is passed on."""

import socket
from dataclasses import dataclass

import msgspec

from fullpose_server.people.admitted import Admitted, Credential
from fullpose_server.store.audit_entry import AuditEntry

CONNECTION, MESSAGE = b"C", b"M"
_PART = 500  # credentials in one packet
MAX_PACKET = 1 << 18  # [bytes] more than a first request may have


class RigRuns(msgspec.Struct, tag=True, frozen=True):
    """Server to gate: a process runs for the rig."""

    rig: str
    pid: int
    memory: str  # its path


class RigLeft(msgspec.Struct, tag=True, frozen=True):
    """Server to gate: the server has let go of the rig."""

    rig: str


class Ending(msgspec.Struct, tag=True, frozen=True):
    """Server to gate: nothing but stops is served any more."""


class LetIn(msgspec.Struct, tag=True, frozen=True):
    """Server to gate: who may stop a rig, a part of them; from `first` to `last` it replaces what was told before."""

    people: bool  # False: there are none, and anybody may
    credentials: list[Credential]
    first: bool
    last: bool


class Stopped(msgspec.Struct, tag=True, frozen=True):
    """Gate to server: for the audit."""

    entry: AuditEntry


class Alive(msgspec.Struct, tag=True, frozen=True):
    """Gate to server: nothing else to say."""


ToGate = RigRuns | RigLeft | LetIn | Ending
ToServer = Stopped | Alive
_to_gate = msgspec.json.Decoder(ToGate).decode
_to_server = msgspec.json.Decoder(ToServer).decode


class NoDescriptorError(Exception):
    """This process may have no more files: a connection that was passed on is lost."""

    def __init__(self) -> None:
        super().__init__("no descriptor left for a connection that the gate passed on: it is lost")


@dataclass(frozen=True)
class Passed:
    """A connection, and what has been read of it."""

    socket: socket.socket
    data: bytes


def let_in(admitted: Admitted) -> list[LetIn]:
    """Who is let in, as the messages that tell it."""
    held = admitted.all()
    parts = [held[begin : begin + _PART] for begin in range(0, len(held), _PART)] or [[]]
    ends = len(parts) - 1
    return [LetIn(admitted.people, part, first=i == 0, last=i == ends) for i, part in enumerate(parts)]


def link() -> tuple[socket.socket, socket.socket]:
    """The two ends between server and gate, non-blocking."""
    ends = socket.socketpair(socket.AF_UNIX, socket.SOCK_SEQPACKET)
    for end in ends:
        end.setblocking(False)
        end.setsockopt(socket.SOL_SOCKET, socket.SO_SNDBUF, 8 * MAX_PACKET)
    return ends


def send(end: socket.socket, message: ToGate | ToServer) -> None:
    """Raises `BlockingIOError` where the other end does not keep up, `OSError` where it is gone."""
    end.send(MESSAGE + msgspec.json.encode(message))


def pass_on(end: socket.socket, connection: socket.socket, data: bytes) -> None:
    """Hand a connection over, with what was read of it; ours is to be closed then. Raises as `send`."""
    socket.send_fds(end, [CONNECTION + data], [connection.fileno()])


def for_gate(end: socket.socket) -> ToGate | None:
    """The next message; None where the server is gone. Raises `BlockingIOError` where there is none yet."""
    packet = end.recv(MAX_PACKET)
    return _to_gate(packet[1:]) if packet else None


def for_server(end: socket.socket) -> Passed | ToServer | None:
    """The next message or connection; None where the gate is gone. Raises `BlockingIOError` where there is none yet.

    Raises `NoDescriptorError`.
    """
    packet, descriptors, _, _ = socket.recv_fds(end, MAX_PACKET, 1)
    if not packet:
        return None
    if packet[:1] == MESSAGE:
        told: ToServer = _to_server(packet[1:])
        return told
    if not descriptors:
        raise NoDescriptorError
    return Passed(socket.socket(fileno=descriptors[0]), packet[1:])
