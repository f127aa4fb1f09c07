"""A real PostgreSQL from the system's package, for the tests of one process; each test has a database of its own.

It listens on a socket in a folder of its own and nowhere else, and writes nothing through to the disk.
"""

import os
import pwd
import shutil
import signal
import subprocess
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from itertools import count
from pathlib import Path

from fullpose_server.location import PostgresqlUrl
from fullpose_server.store.database import Database

USER = "fullpose"
FAST = ("fsync=off", "synchronous_commit=off", "full_page_writes=off", "max_connections=60", "shared_buffers=16MB")


def programs() -> Path | None:
    """The folder of the newest PostgreSQL that is installed; None where none is."""
    found = sorted(Path("/usr/lib/postgresql").glob("*/bin/initdb"), key=lambda path: int(path.parts[-3]))
    if found:
        return found[-1].parent
    initdb = shutil.which("initdb")
    return None if initdb is None else Path(initdb).parent


class Server:
    """One that runs. Databases are copies of one that was migrated once."""

    def __init__(self, folder: Path, bin_: Path, process: "subprocess.Popen[bytes]") -> None:
        self.folder = folder
        self.process = process
        self._bin = bin_
        self._numbers = count(1)
        self._template = ""

    def url(self, database: str) -> PostgresqlUrl:
        """Of one of its databases."""
        return PostgresqlUrl.of(f"postgresql://{USER}@/{database}?host={self.folder}")

    def made(self, *, migrated: bool = True) -> PostgresqlUrl:
        """A new database."""
        name = f"test{next(self._numbers)}"
        if migrated and not self._template:
            self._template = "template_of_tests"
            self._create(self._template)
            Database(self.url(self._template)).close()
        self._create(name, *(["--template", self._template] if migrated else []))
        return self.url(name)

    def stop_answering(self) -> None:
        """Every process of it hangs, as one does on a disk that is gone."""
        self._signal(signal.SIGSTOP)

    def answer(self) -> None:
        """They go on."""
        self._signal(signal.SIGCONT)

    def _signal(self, what: signal.Signals) -> None:
        children = Path(f"/proc/{self.process.pid}/task/{self.process.pid}/children").read_text().split()
        for pid in (self.process.pid, *map(int, children)):
            os.kill(pid, what)

    def _create(self, name: str, *more: str) -> None:
        command = [self._bin / "createdb", "--host", self.folder, "--username", USER, *more, name]
        subprocess.run(command, check=True, capture_output=True, timeout=300)


@contextmanager
def running_postgresql() -> Iterator[Server]:
    """Make one, run it, and take it away. As root it runs as the package's own user, for it refuses to be root."""
    bin_ = programs()
    assert bin_ is not None
    folder = Path(tempfile.mkdtemp(prefix="fullpose-pg-", dir="/tmp"))  # a socket's path is short
    as_: dict[str, object] = {}
    if os.geteuid() == 0:
        them = pwd.getpwnam("postgres")
        os.chown(folder, them.pw_uid, them.pw_gid)
        as_ = {"user": them.pw_uid, "group": them.pw_gid, "extra_groups": []}
    data = folder / "data"
    made = ["--auth=trust", f"--username={USER}", "--encoding=UTF8", "--locale=C.UTF-8", "--no-sync"]
    subprocess.run([bin_ / "initdb", "-D", data, *made], check=True, capture_output=True, timeout=300, cwd="/", **as_)  # type: ignore[call-overload]
    options = [part for option in FAST for part in ("-c", option)]
    command = [bin_ / "postgres", "-D", data, "-c", "listen_addresses=", "-k", folder, *options]
    log = (folder / "log").open("wb")
    process = subprocess.Popen(command, stdout=log, stderr=log, cwd="/", **as_)  # type: ignore[call-overload]
    try:
        asked = [bin_ / "pg_isready", "--host", folder, "--timeout", "60"]
        while subprocess.run(asked, capture_output=True, check=False).returncode != 0:
            assert process.poll() is None, (folder / "log").read_text()
        yield Server(folder, bin_, process)
    finally:
        if process.poll() is None:
            process.send_signal(signal.SIGCONT)
            process.send_signal(signal.SIGQUIT)  # at once
        process.wait(60)
        log.close()
        shutil.rmtree(folder, ignore_errors=True)
