"""podman as the tests use it: a network of their own, the server's container and what stands beside it."""

import json
import os
import secrets
import shutil
import subprocess
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from types import TracebackType
from typing import Any, Self

import httpx

from tests.containers.composed import arguments
from tests.support.waiting import until

PODMAN = ("podman", "--runtime", "runc")
PEERS = "localhost/fullpose-peers:test"
PORT = 8642
PASSWORD = "correct horse battery"  # of both the-admin and the-viewer
UID = 10001  # of the image's user
PYTHON = "/opt/fullpose/bin/python"
# Ends a process of the container, found by a word of its command line, with all the rights its own user has.
KILL = """
import os, pathlib, sys
word, number = sys.argv[1], int(sys.argv[2])
for folder in pathlib.Path("/proc").glob("[0-9]*"):
    try:
        command = (folder / "cmdline").read_bytes().decode().replace("\\0", " ")
    except OSError:
        continue
    if word in command and int(folder.name) not in (1, os.getpid()):
        os.kill(int(folder.name), number)
        print(folder.name)
"""


def podman(*command: str, check: bool = True, timeout_s: float = 300.0, given: str = "") -> str:
    """What podman says on stdout. Raises `AssertionError` with what it says on stderr. `given`: its standard input."""
    done = subprocess.run(
        [*PODMAN, *command], input=given, capture_output=True, text=True, check=False, timeout=timeout_s
    )
    assert done.returncode == 0 or not check, f"podman {' '.join(command)}: {done.stderr or done.stdout}"
    return done.stdout.strip()


class Box:
    """One container, by its name."""

    def __init__(self, name: str, address: str, tokens: dict[str, str] | None = None) -> None:
        self.name = name
        self.tokens = tokens or {}  # by role
        self.token = self.tokens.get("admin", "")
        self.headers = {"Authorization": f"Bearer {self.token}"}
        self.address = address
        self.url = f"http://{address}:{PORT}"

    def inspect(self, template: str) -> str:
        return podman("inspect", "--format", template, self.name)

    def run(self, *command: str) -> subprocess.CompletedProcess[str]:
        """A command inside; its status is its own."""
        return subprocess.run(
            [*PODMAN, "exec", self.name, *command], capture_output=True, text=True, check=False, timeout=300.0
        )

    def kill(self, word: str, number: int = 9) -> list[int]:
        """Signal the processes inside whose command has the word; their numbers there."""
        said = self.run(PYTHON, "-c", KILL, word, str(number))
        assert said.returncode == 0, said.stderr
        return [int(pid) for pid in said.stdout.split()]

    def logs(self) -> str:
        """Both streams."""
        done = subprocess.run([*PODMAN, "logs", self.name], capture_output=True, text=True, check=False)
        return done.stdout + done.stderr

    def health(self) -> dict[str, Any] | None:
        """The server's; None where it does not answer."""
        try:
            answer: dict[str, Any] = httpx.get(f"{self.url}/api/v1/health", headers=self.headers, timeout=10.0).json()
        except (httpx.TransportError, json.JSONDecodeError):
            return None
        return answer

    def check(self) -> tuple[int, str]:
        """The image's health check, run inside as the engine runs it: its status, and what it says."""
        done = self.run(PYTHON, "/opt/fullpose/health.py")
        return done.returncode, done.stdout.strip()

    def wait_healthy(self) -> None:
        """Until the planner is there too."""
        until(lambda: (told := self.health()) is not None and told.get("planner") == "idle", every_s=0.2)


class Engine:
    """What is started in it ends with it. Containers have fixed addresses, so that a restart moves nobody."""

    def __init__(self, image: str) -> None:
        self.image = image
        self._prefix = f"fullpose-{os.getpid()}-{secrets.token_hex(2)}"
        self._volumes: list[str] = []
        self._boxes: list[str] = []
        self._next = 10

    def __enter__(self) -> Self:
        podman("network", "create", "--disable-dns", self._prefix)
        shown = json.loads(podman("network", "inspect", self._prefix))[0]
        self._net = shown["subnets"][0]["subnet"].rsplit(".", 1)[0]
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        for name in self._boxes:
            podman("rm", "--force", "--time", "5", "--ignore", name, check=False)
        for volume in self._volumes:
            podman("volume", "rm", "--force", volume, check=False)
        podman("network", "rm", "--force", self._prefix, check=False)

    def volumes(self, *names: str) -> dict[str, str]:
        """Volumes of this engine's own for the names that compose.yaml has."""
        made = {name: f"{self._prefix}-{name}-{secrets.token_hex(2)}" for name in names}
        for name in made.values():
            podman("volume", "create", name)
        self._volumes += made.values()
        return made

    def start(
        self, image: str, *options: str, command: tuple[str, ...] = (), tokens: dict[str, str] | None = None
    ) -> Box:
        """A container with an address of its own."""
        self._next += 1
        box = Box(f"{self._prefix}-{self._next}", f"{self._net}.{self._next}", tokens)
        self._boxes.append(box.name)
        # The hardware's address follows from it, as with docker: who has it in mind would ask the one before for half a
        # minute, where a container that is started anew had another.
        hardware = ":".join(f"{byte:02x}" for byte in (0x02, 0x42, *map(int, box.address.split("."))))
        network = ("--network", self._prefix, "--ip", box.address, "--mac-address", hardware)
        podman("run", "--detach", "--name", box.name, *network, *options, image, *command)
        return box

    @contextmanager
    def server(
        self, *, rig: str = "", volumes: dict[str, str] | None = None, capabilities: bool = True
    ) -> Iterator[Box]:
        """The server as compose.yaml has it, on new volumes where none are named. `rig`: a rig file's text."""
        volumes = volumes or self.volumes("data", "kernels")
        if rig:
            write_rig(volumes["data"], rig)
        options = arguments("fullpose", volumes, capabilities=capabilities)
        once = ("run", "--rm", "--interactive", "--network", "none", *options, self.image)
        tokens = {}
        for role in ("admin", "viewer"):
            added = (*once, "user", "add", f"the-{role}", "--role", role, "--password-stdin")
            podman(*added, given=f"{PASSWORD}\n")
            tokens[role] = podman(*once, "token", "create", f"the-{role}").splitlines()[0]
        box = self.start(self.image, *options, tokens=tokens)
        try:
            yield box
        finally:
            if os.environ.get("LOGS"):
                print(box.logs())
            podman("rm", "--force", "--time", "5", box.name, check=False)


def write_rig(volume: str, text: str) -> None:
    """Put a rig file into a data volume that nobody uses yet."""
    data = Path(podman("volume", "inspect", "--format", "{{.Mountpoint}}", volume))
    (data / "rigs").mkdir(exist_ok=True)
    (data / "rigs" / "bench.toml").write_text(text, encoding="utf-8")
    for path in (data, data / "rigs", data / "rigs" / "bench.toml"):
        shutil.chown(path, UID, UID)
