"""The rig process's end of the control socket, polled as its loop does."""

import socket
from collections.abc import Iterator
from pathlib import Path

import pytest

from fullpose_server.runtime.contract import messages
from fullpose_server.runtime.contract.rig_paths import RigPaths, control_socket
from fullpose_server.runtime.loop.control_server import ControlServer


class CommandHandler:
    """Answers everything, with a long word, and keeps what it was asked."""

    def __init__(self) -> None:
        self.asked: list[int] = []

    def answer(self, request: messages.Request) -> messages.Answer:
        self.asked.append(request.id)
        error = messages.ErrorBody("bad_request", "x" * 2000, "idle", request.op, [])
        return messages.Answer(request.id, messages.Reply(False, "idle", "idle", 0, error))


@pytest.fixture
def paths(tmp_path: Path) -> RigPaths:
    return RigPaths(tmp_path)


@pytest.fixture
def handler() -> CommandHandler:
    return CommandHandler()


@pytest.fixture
def server(paths: RigPaths, handler: CommandHandler) -> Iterator[ControlServer]:
    made = ControlServer(paths, handler.answer)
    yield made
    made.close()


def client(paths: RigPaths) -> socket.socket:
    made = control_socket()
    with paths.socket_address("control.sock") as address:
        made.connect(address)
    return made


def send(to: socket.socket, number: int) -> bool:
    """Whether the socket took it."""
    try:
        to.send(messages.encode(messages.Request(number, messages.Op.COMMAND, "test", "load")))
    except BlockingIOError:
        return False
    return True


def answers(of: socket.socket) -> list[int]:
    """The numbers of the answers that are there."""
    found = []
    while True:
        try:
            found.append(messages.decode_answer(of.recv(1 << 16)).id)
        except BlockingIOError:
            return found


def test_who_does_not_read_its_answers_is_not_obeyed_until_it_does(
    paths: RigPaths, server: ControlServer, handler: CommandHandler
) -> None:
    with client(paths) as slow, client(paths) as other:
        sent = 0
        for _ in range(3000):  # far more than fit into the socket either way
            sent += send(slow, sent)
            server.poll()
        assert 0 < len(handler.asked) < sent
        stuck = len(handler.asked)
        for _ in range(100):
            server.poll()
        assert len(handler.asked) == stuck

        assert send(other, 100_000)  # is not kept waiting
        for _ in range(3):
            server.poll()
        assert answers(other) == [100_000]
        assert len(handler.asked) == stuck + 1

        heard: list[int] = []
        while len(heard) < sent:
            before = len(heard)
            for _ in range(50):
                server.poll()
                heard += answers(slow)
            assert len(heard) > before
        assert heard == list(range(sent))
        assert [n for n in handler.asked if n != 100_000] == heard  # each obeyed once, and in order


def test_who_goes_with_an_answer_waiting_is_forgotten(
    paths: RigPaths, server: ControlServer, handler: CommandHandler
) -> None:
    slow = client(paths)
    for number in range(3000):
        send(slow, number)
        server.poll()
    slow.close()
    for _ in range(10):
        server.poll()
    with client(paths) as other:
        send(other, 1)
        for _ in range(3):
            server.poll()
        assert answers(other) == [1]


def test_what_is_no_request_ends_the_connection_it_came_by(
    paths: RigPaths, server: ControlServer, handler: CommandHandler
) -> None:
    with client(paths) as wrong, client(paths) as right:
        wrong.send(b"no request")
        assert send(right, 7)
        for _ in range(5):
            server.poll()
        assert answers(right) == [7]
        assert wrong.recv(10) == b""
    assert handler.asked == [7]
