"""What hostile or careless clients do to a server: each until its stdin ends; the first line says that it begins.

`python -m bench.realtime.attacks NAME --port P --data FOLDER`; `NAMES` has the names.
"""

import argparse
import contextlib
import http.client
import io
import json
import socket
import sqlite3
import sys
import threading
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq

from bench.realtime.rig_load import Viewer, plan, post

RIG = "vertical-4"
JSON_BYTES = 100_000_000
SOLVE_SAMPLES = 1_000_000
BOMB_ROWS = 20_000_000
LOCK_S = 30.0
IDLE = 1100
SILENT = 500


class Attack:
    """Where the server is, and whether to go on."""

    def __init__(self, port: int, data: Path) -> None:
        self.port = port
        self.data = data
        self.over = threading.Event()
        self._answers: dict[str, int] = {}

    def in_threads(self, work: Callable[[int], None], count: int) -> None:
        """`work(k)` over and over in `count` threads."""

        def repeated(number: int) -> None:
            while not self.over.is_set():
                with contextlib.suppress(OSError, http.client.HTTPException):
                    work(number)

        for number in range(count):
            threading.Thread(target=repeated, args=(number,), daemon=True).start()
        self.over.wait()

    def send(self, path: str, body: bytes | bytearray, content_type: str = "application/json") -> None:
        """POST it, and count the answer; a server that closes before it is sent is one too."""
        link = http.client.HTTPConnection("127.0.0.1", self.port, timeout=120)
        try:
            with contextlib.suppress(BrokenPipeError, ConnectionResetError):
                link.request("POST", f"/api/v1{path}", body, {"Content-Type": content_type})
            self.count(str(link.getresponse().status))
        except (OSError, http.client.HTTPException) as cause:
            self.count(type(cause).__name__)
        finally:
            link.close()

    def count(self, answer: str) -> None:
        """One more such answer."""
        self._answers[answer] = self._answers.get(answer, 0) + 1

    def told(self) -> str:
        """The answers that came."""
        return ", ".join(f"{count} x {answer}" for answer, count in sorted(self._answers.items()))


def json_bodies(attack: Attack) -> None:
    """100 MB of JSON to three routes that want none of it."""
    body = b'{"name":"' + b"x" * (JSON_BYTES - 12) + b'"}'
    paths = ["/plans", f"/rigs/{RIG}/lease", "/compare"]
    attack.in_threads(lambda k: attack.send(paths[k], body), len(paths))


def large_solve(attack: Attack) -> None:
    """A million attitudes in one POST /solve, over and over."""
    row = b"[1.0,0.0,0.0,0.0]"
    body = b'{"rig":"%s","q":[%s]}' % (RIG.encode(), b",".join([row] * SOLVE_SAMPLES))
    attack.in_threads(lambda _: attack.send("/solve", body), 1)


def bombs(attack: Attack) -> None:
    """Eight at a time: small Parquet files of very many rows."""
    chunk = pa.chunked_array([pa.array(np.zeros(1_000_000))] * (BOMB_ROWS // 1_000_000))
    table = pa.table(dict.fromkeys(("time_s", "yaw_deg", "pitch_deg", "roll_deg"), chunk))
    file = io.BytesIO()
    pq.write_table(table, file, compression="zstd", row_group_size=BOMB_ROWS)
    head = b'--b\r\nContent-Disposition: form-data; name="file"; filename="bomb.parquet"\r\n\r\n'
    body = head + file.getvalue() + b"\r\n--b--\r\n"
    attack.count(f"a bomb of {len(file.getvalue()) // 1000} kB and {BOMB_ROWS} rows")
    attack.in_threads(lambda _: attack.send("/trajectories", body, "multipart/form-data; boundary=b"), 8)


def locked_database(attack: Attack) -> None:
    """The database locked for 30 s, over and over."""

    def lock(_: int) -> None:
        link = sqlite3.connect(attack.data / "fullpose.db", isolation_level=None, timeout=60)
        link.execute("BEGIN EXCLUSIVE")
        attack.count("locked")
        attack.over.wait(LOCK_S)
        link.execute("ROLLBACK")
        link.close()

    attack.in_threads(lock, 1)


def idle(attack: Attack) -> None:
    """1100 connections that ask for nothing, replaced where they are closed."""
    held: list[socket.socket] = []
    while not attack.over.is_set():
        while len(held) < IDLE and not attack.over.is_set():
            with contextlib.suppress(OSError):
                held.append(socket.create_connection(("127.0.0.1", attack.port), timeout=5))
                held[-1].setblocking(False)
        alive = []
        for one in held:
            try:
                closed = one.recv(1) == b""
            except BlockingIOError:
                closed = False
            except OSError:
                closed = True
            if closed:
                attack.count("closed by the server")
                one.close()
            else:
                alive.append(one)
        held = alive
        attack.over.wait(0.2)


def silent_viewers(attack: Attack) -> None:
    """500 viewers that never read what they asked for."""
    held = []
    for _ in range(SILENT):
        with contextlib.suppress(OSError, AssertionError):
            held.append(Viewer(attack.port, RIG))
    attack.count(f"{len(held)} viewers")
    attack.over.wait()


def busy(attack: Attack) -> None:
    """Planner and comparisons without a pause."""
    t = np.arange(0.0, 10.0, 2e-3)
    angles = {"yaw_deg": (90 * np.sin(t)).tolist(), "pitch_deg": (30 * np.sin(t)).tolist(), "roll_deg": t.tolist()}
    status, body = post(
        attack.port, "/trajectories", {"name": "busy", "convention": "nue", "time_s": t.tolist(), **angles}
    )
    assert status in (200, 201), body
    wanted = {"trajectory": json.loads(body)["sha256"], "rig": RIG, "methods": ["plan", "exact", "clamped", "preview"]}

    def compare(_: int) -> None:
        status, _body = post(attack.port, "/compare", wanted)
        attack.count(f"comparison {status}")
        time.sleep(0.5)

    end = time.monotonic() + 1e6
    threading.Thread(target=plan, args=(attack.port, RIG, end, attack.over), daemon=True).start()
    attack.in_threads(compare, 1)


NAMES: dict[str, Callable[[Attack], None]] = {
    "json": json_bodies,
    "solve": large_solve,
    "bombs": bombs,
    "locked": locked_database,
    "idle": idle,
    "viewers": silent_viewers,
    "busy": busy,
}


def main() -> None:
    """Attack until stdin ends; then say what came back."""
    arguments = argparse.ArgumentParser(description=__doc__)
    arguments.add_argument("name", choices=NAMES)
    arguments.add_argument("--port", type=int, required=True)
    arguments.add_argument("--data", type=Path, required=True)
    given = arguments.parse_args()
    attack = Attack(given.port, given.data)

    def until_stdin_ends() -> None:
        sys.stdin.read()
        attack.over.set()

    threading.Thread(target=until_stdin_ends, daemon=True).start()
    print(f"# {given.name} begins", flush=True)
    NAMES[given.name](attack)
    print(f"# {given.name}: {attack.told()}", flush=True)


if __name__ == "__main__":
    main()
