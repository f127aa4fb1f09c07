"""Load for the rig benchmarks: stream viewers, uploads and planning jobs against a real `fullpose serve`.

`python -m bench.realtime.rig_load --port P --rig R --viewers N --seconds S [--upload] [--plan]` is the load, a process
that costs little beside what the server does for it. Viewers are plain sockets that count frames and look into none.
Uploads (100 MB each) and planning jobs follow one another without a pause for as long as it runs.
"""

import argparse
import base64
import contextlib
import http.client
import json
import os
import selectors
import socket
import subprocess
import sys
import threading
import time
from collections.abc import Iterator
from pathlib import Path

import numpy as np

UPLOAD_BYTES = 100_000_000
ROW_BYTES = 37
_PING, _PONG = 0x89, 0x8A  # a WebSocket frame's first byte


def post(port: int, path: str, body: object, who: str = "bench") -> tuple[int, bytes]:
    """POST JSON to the server; status and body."""
    link = http.client.HTTPConnection("127.0.0.1", port, timeout=60)
    headers = {"Content-Type": "application/json", "X-Fullpose-Client": who}
    link.request("POST", f"/api/v1{path}", json.dumps(body), headers)
    answer = link.getresponse()
    content = answer.read()
    link.close()
    return answer.status, content


def get(port: int, path: str) -> bytes:
    """GET; the body."""
    link = http.client.HTTPConnection("127.0.0.1", port, timeout=60)
    link.request("GET", f"/api/v1{path}")
    content = link.getresponse().read()
    link.close()
    return content


@contextlib.contextmanager
def served(data: Path, files: int | None = None) -> Iterator[tuple[int, int]]:
    """`fullpose serve` on a free port of loopback, with at most so many files open: port and process."""
    command = [] if files is None else ["prlimit", f"--nofile={files}:{files}"]
    command += [sys.executable, "-c", "from fullpose_server.cli import main; main()", "serve", "--port", "0"]
    command += ["--data-dir", str(data)]
    process = subprocess.Popen(command, stdout=subprocess.PIPE, text=True)
    assert process.stdout is not None
    try:
        port = int(process.stdout.readline().rsplit(":", 1)[1])
        get(port, "/health")
        yield port, process.pid
    finally:
        process.terminate()
        process.wait(60)
        process.stdout.close()


@contextlib.contextmanager
def loaded(port: int, rig: str, viewers: int, seconds: float, *, upload: bool, plan: bool) -> Iterator[None]:
    """Viewers, and where asked uploads and planning jobs, for at most `seconds`; ended with the block."""
    command = [sys.executable, "-m", "bench.realtime.rig_load", "--port", str(port), "--rig", rig]
    command += ["--viewers", str(viewers), "--seconds", str(seconds)]
    command += [*(["--upload"] if upload else []), *(["--plan"] if plan else [])]
    process = subprocess.Popen(command, stdin=subprocess.PIPE)
    assert process.stdin is not None
    try:
        yield
    finally:
        process.stdin.close()
        process.wait(60)


class Viewer:
    """One viewer at 30 frames a second: `frames` counts the messages that came. It answers pings, as a viewer must."""

    def __init__(self, port: int, rig: str) -> None:
        self.frames = 0
        self._need = 0  # bytes of the message under way that have not come
        self._rest = b""  # a header that has not come whole
        self.link = socket.create_connection(("127.0.0.1", port), timeout=60)
        self.link.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)  # as browsers do
        key = base64.b64encode(os.urandom(16)).decode()
        self.link.sendall(
            f"GET /api/v1/rigs/{rig}/stream HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\nUpgrade: websocket\r\n"
            f"Connection: Upgrade\r\nSec-WebSocket-Key: {key}\r\nSec-WebSocket-Version: 13\r\n\r\n".encode()
        )
        head = b""
        while b"\r\n\r\n" not in head:
            got = self.link.recv(65536)
            if not got:
                raise OSError(f"refused: {head!r}")
            head += got
        assert b" 101 " in head.splitlines()[0], head
        self._count(head.split(b"\r\n\r\n", 1)[1])
        # A client's frames are masked; a mask of zeros leaves them as they are.
        self.send(json.dumps({"type": "subscribe", "rate_hz": 30}).encode())
        self.link.setblocking(False)

    def send(self, payload: bytes) -> None:
        """A message of text, shorter than 126 bytes."""
        assert len(payload) < 126
        self.link.sendall(bytes([0x81, 0x80 | len(payload)]) + bytes(4) + payload)

    def read(self) -> bool:
        """Count what has come; False at the end."""
        got = self.link.recv(262144)
        self._count(got)
        return bool(got)

    def _count(self, data: bytes) -> None:
        while data:
            if self._need:
                taken = min(self._need, len(data))
                self._need -= taken
                data = data[taken:]
                continue
            data, self._rest = self._rest + data, b""
            size = data[1] & 127 if len(data) > 1 else 0
            head = 2 + (2 if size == 126 else 8 if size == 127 else 0)
            ping = data[0] == _PING
            if len(data) < max(2, head) or (ping and len(data) < head + size):
                self._rest = data
                return
            if ping:
                self.link.sendall(bytes([_PONG, 0x80 | size]) + bytes(4) + data[head : head + size])
                data = data[head + size :]
                continue
            self._need = int.from_bytes(data[2:head], "big") if size >= 126 else size
            data = data[head:]
            self.frames += 1


def view(port: int, rig: str, viewers: int, end: float, stop: threading.Event) -> None:
    """All viewers until `end`, then say how many frames came, and how many the slowest viewer had."""
    chosen = selectors.DefaultSelector()
    watching = []
    for _ in range(viewers):
        watching.append(Viewer(port, rig))
        chosen.register(watching[-1].link, selectors.EVENT_READ, watching[-1])
    before = [viewer.frames for viewer in watching]
    begun = time.monotonic()
    while time.monotonic() < end and not stop.is_set():
        for key, _ in chosen.select(0.2):
            with contextlib.suppress(BlockingIOError):
                if not key.data.read():
                    chosen.unregister(key.data.link)
    took = time.monotonic() - begun
    rates = [(viewer.frames - first) / took for viewer, first in zip(watching, before, strict=True)]
    if rates:
        used = sum(os.times()[:2]) / took
        print(
            f"# {viewers} viewers: {np.mean(rates):.1f} frames/s each, the slowest {min(rates):.1f}; "
            f"the load's own process {100 * used:.0f} % of a core",
            flush=True,
        )


def upload(port: int, end: float, stop: threading.Event) -> None:
    """100 MB of CSV, a flight of 2.8 million samples, sent as fast as they are taken; again and again."""
    count = UPLOAD_BYTES // ROW_BYTES
    rows = bytearray()
    while time.monotonic() < end and not stop.is_set():
        head = (
            b'--b\r\nContent-Disposition: form-data; name="name"\r\n\r\nbig\r\n--b\r\n'
            b'Content-Disposition: form-data; name="file"; filename="big.csv"\r\n\r\n'
            b"time_s,yaw_deg,pitch_deg,roll_deg\n"
        )
        tail = b"\r\n--b--\r\n"
        if not rows:
            for k in range(count):
                rows += b"%08d.%03d,1.0000000,2.0000,3.0000\n" % divmod(k, 1000)
            assert len(rows) == count * ROW_BYTES, len(rows) / count
        link = http.client.HTTPConnection("127.0.0.1", port, timeout=300)
        link.putrequest("POST", "/api/v1/trajectories")
        link.putheader("Content-Type", "multipart/form-data; boundary=b")
        link.putheader("Content-Length", str(len(head) + len(rows) + len(tail)))
        link.endheaders(head)
        with contextlib.suppress(OSError, http.client.HTTPException):
            link.send(rows)
            link.send(tail)
            answer = link.getresponse()
            told = answer.read()
            assert answer.status in (200, 201), told
        link.close()


def plan(port: int, rig: str, end: float, stop: threading.Event) -> None:
    """Plans of a flight of ten seconds, by the server's own planning process, one after another."""
    t = np.arange(0.0, 10.0, 1e-3)
    flight = {
        "time_s": t.tolist(),
        "yaw_deg": (90.0 * np.sin(t)).tolist(),
        "pitch_deg": (30.0 * np.sin(0.7 * t)).tolist(),
        "roll_deg": (120.0 * np.sin(0.5 * t)).tolist(),
    }
    status, body = post(port, "/trajectories", {"name": "planned", "convention": "nue", **flight})
    assert status in (200, 201), body
    trajectory = json.loads(body)["sha256"]
    while time.monotonic() < end and not stop.is_set():
        status, body = post(port, "/plans", {"trajectory": trajectory, "rig": rig, "method": "plan"})
        assert status == 202, body
        name = json.loads(body)["id"]
        while time.monotonic() < end and not stop.is_set():
            if json.loads(get(port, f"/plans/{name}"))["status"] not in ("queued", "running"):
                break
            time.sleep(0.1)


def _until_stdin_ends(stop: threading.Event) -> None:
    sys.stdin.read()
    stop.set()


def main() -> None:
    """Until the time is over, or stdin ends."""
    arguments = argparse.ArgumentParser()
    arguments.add_argument("--port", type=int, required=True)
    arguments.add_argument("--rig", required=True)
    arguments.add_argument("--viewers", type=int, default=200)
    arguments.add_argument("--seconds", type=float, default=60.0)
    arguments.add_argument("--upload", action="store_true")
    arguments.add_argument("--plan", action="store_true")
    given = arguments.parse_args()
    end = time.monotonic() + given.seconds
    stop = threading.Event()
    threading.Thread(target=_until_stdin_ends, args=(stop,), daemon=True).start()
    if given.upload:
        threading.Thread(target=upload, args=(given.port, end, stop), daemon=True).start()
    if given.plan:
        threading.Thread(target=plan, args=(given.port, given.rig, end, stop), daemon=True).start()
    view(given.port, given.rig, given.viewers, end, stop)


if __name__ == "__main__":
    main()
