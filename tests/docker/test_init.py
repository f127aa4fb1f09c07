"""The container's first process, in a process namespace of its own: rigs outlive a killed server, brake at the end."""

import os
import signal
import socket
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import httpx
import pytest

from fullpose_server.settings import Settings
from tests.fullpose_server.api.live_server import LiveServer, Operator
from tests.support.repository import PYTHONPATH, ROOT
from tests.support.waiting import until

INIT = ROOT / "docker" / "init.py"
NAMESPACE = ("unshare", "--pid", "--fork", "--mount-proc", "--kill-child")
SERVER = "from fullpose_server.cli import main; main()"


def _allowed() -> bool:
    tried = subprocess.run([*NAMESPACE, "true"], capture_output=True, check=False)
    return tried.returncode == 0


pytestmark = pytest.mark.skipif(not _allowed(), reason="a process namespace is not allowed here")


def children(pid: int) -> list[int]:
    """Of a process, by their numbers outside of the container."""
    try:
        return [int(child) for child in Path(f"/proc/{pid}/task/{pid}/children").read_text().split()]
    except OSError:
        return []


def command_of(pid: int) -> str:
    try:
        return Path(f"/proc/{pid}/cmdline").read_bytes().replace(b"\0", b" ").decode()
    except OSError:
        return ""


class Container:
    """What runs in the namespace; `init` is its first process."""

    def __init__(self, *command: str) -> None:
        self.outside = subprocess.Popen(
            [*NAMESPACE, sys.executable, str(INIT), *command],
            env=os.environ | {"PYTHONPATH": PYTHONPATH},
            stdout=subprocess.DEVNULL,
            stderr=subprocess.PIPE,
            text=True,
        )
        self.init = until(lambda: (children(self.outside.pid) or [0])[0])

    def ended(self) -> tuple[int, str]:
        """Its exit status, and what it said."""
        _, said = self.outside.communicate(timeout=120)
        return self.outside.returncode, said


@contextmanager
def container(*command: str) -> Iterator[Container]:
    made = Container(*command)
    try:
        yield made
    finally:
        made.outside.kill()
        made.outside.communicate()


def free_port() -> int:
    with socket.socket() as asked:
        asked.bind(("127.0.0.1", 0))
        port: int = asked.getsockname()[1]
        return port


def answers(server: LiveServer) -> bool:
    try:
        return server.http.get("/health").status_code in (200, 503)
    except httpx.TransportError:
        return False


def started(box: Container, word: str) -> int:
    """The child of init whose command has this word."""
    return until(lambda: next((pid for pid in children(box.init) if word in command_of(pid)), 0))


def test_a_killed_server_comes_back_and_adopts_and_the_end_brakes(tmp_path: Path) -> None:
    port = free_port()
    served = ("serve", "--port", str(port), "--data-dir", str(tmp_path))
    with container(sys.executable, "-c", SERVER, *served) as box:
        server = LiveServer(port, Settings(data_dir=tmp_path))
        until(lambda: answers(server))
        plan = server.plan()
        operator = Operator(server)
        operator.take()
        for word, args in (("connect", {}), ("load", {"plan": plan["id"]}), ("arm", {})):
            done = operator.command(word, **args)
            assert done.status_code == 200, done.text
        before = operator.session()["health"]
        killed = started(box, "serve")
        os.kill(killed, signal.SIGKILL)
        until(lambda: not Path(f"/proc/{killed}").exists())
        until(lambda: answers(server))
        health = until(lambda: _alive(operator))
        assert health["rig_pid"] == before["rig_pid"]  # the very process
        assert health["ticks"] > before["ticks"]
        operator.take()
        moved = operator.command("jog", frame="outer", step_deg=90.0)
        assert moved.status_code == 200, moved.text
        operator.wait("positioning")
        rigs = [pid for pid in children(box.init) if "runtime.loop.process" in command_of(pid)]
        killed = started(box, "serve")
        os.kill(box.init, signal.SIGTERM)
        code, said = box.ended()
        assert "started anew" in said
        assert code == 0, said
        assert not any(Path(f"/proc/{pid}").exists() for pid in rigs)
    assert not list((tmp_path / "rigs").rglob("process.json"))  # they ended by themselves, in order


def _alive(operator: Operator) -> dict[str, Any] | None:
    health: dict[str, Any] = operator.session()["health"]
    return health if health["rig_alive"] else None


def test_a_server_that_ends_by_itself_ends_the_container_with_its_status() -> None:
    with container(sys.executable, "-c", "raise SystemExit(2)") as box:
        assert box.ended()[0] == 2


def test_orphans_are_reaped_told_to_end_and_waited_for(tmp_path: Path) -> None:
    mark = tmp_path / "braked"
    rig = f"""
import os, signal, sys, time
if os.fork():
    os._exit(0)
signal.signal(signal.SIGTERM, lambda *_: (time.sleep(0.5), open({str(mark)!r}, "w").close(), os._exit(0)))
open({str(tmp_path / "ready")!r}, "w").close()
time.sleep(600)
"""
    server = f"""
import os, subprocess, sys, time
subprocess.run([sys.executable, "-c", {rig!r}])
while not os.path.exists({str(tmp_path / "ready")!r}):
    time.sleep(0.01)
sys.exit(7)
"""
    with container(sys.executable, "-c", server) as box:
        assert box.ended()[0] == 7
    assert mark.exists()  # it had its time


def test_one_that_is_killed_again_and_again_is_given_up() -> None:
    with container(sys.executable, "-c", "import os, signal; os.kill(os.getpid(), signal.SIGKILL)") as box:
        code, said = box.ended()
    assert code == 128 + signal.SIGKILL
    assert said.count("started anew") == 4
