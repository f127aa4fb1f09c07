"""Load for the rig benchmarks: a real server, stream viewers, an upload and a planning job, as processes of their own.

`python -m bench.rig_load --port P --rig R --viewers N --seconds S`: the viewers (and, with --upload, a 100 MB upload).
"""

import argparse
import asyncio
import contextlib
import http.client
import json
import socket
import subprocess
import sys
import threading
import time
from collections.abc import Iterator
from pathlib import Path

SERVE = """
import sys, uvicorn
from pathlib import Path
from server.app import create_app
from server.settings import Settings
settings = Settings(port=int(sys.argv[1]), data_dir=Path(sys.argv[2]))
uvicorn.run(create_app(settings), host="127.0.0.1", port=settings.port, log_level="warning", ws_ping_interval=None)
"""
PLAN = """
import time, sys
import numpy as np
from solver.attitude import dcm_from_euler
from solver.rig import builtin_rigs
from solver.solve import solve
t = np.arange(0.0, 10.0, 1e-3)
C = dcm_from_euler(np.radians(90) * np.sin(t), np.radians(30) * np.sin(0.7 * t), np.radians(120) * np.sin(0.5 * t))
end = time.monotonic() + float(sys.argv[1])
while time.monotonic() < end:
    solve(t, C, builtin_rigs()["vertical-limited"], method="plan")
"""
UPLOAD_BYTES = 100_000_000


def post(port: int, path: str, body: object) -> tuple[int, bytes]:
    """POST JSON to the server; status and body."""
    link = http.client.HTTPConnection("127.0.0.1", port, timeout=30)
    link.request("POST", f"/api/v1{path}", json.dumps(body), {"Content-Type": "application/json"})
    answer = link.getresponse()
    content = answer.read()
    link.close()
    return answer.status, content


@contextlib.contextmanager
def served(data: Path) -> Iterator[int]:
    """A server on a free port of loopback."""
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    process = subprocess.Popen([sys.executable, "-c", SERVE, str(port), str(data)])
    try:
        for _ in range(300):
            with contextlib.suppress(OSError):
                link = http.client.HTTPConnection("127.0.0.1", port, timeout=2)
                link.request("GET", "/api/v1/health")
                if link.getresponse().status == 200:
                    break
            time.sleep(0.1)
        else:
            raise RuntimeError("the server does not answer")
        yield port
    finally:
        process.terminate()
        process.wait(60)


@contextlib.contextmanager
def loaded(port: int, rig: str, viewers: int, seconds: float, *, upload: bool, plan: bool) -> Iterator[None]:
    """Viewers, and where asked an upload and a planning job, for `seconds`; ended with the block."""
    command = [sys.executable, "-m", "bench.rig_load", "--port", str(port), "--rig", rig]
    command += ["--viewers", str(viewers), "--seconds", str(seconds), *(["--upload"] if upload else [])]
    started = [subprocess.Popen(command)] if viewers or upload else []
    if plan:
        started.append(subprocess.Popen([sys.executable, "-c", PLAN, str(seconds)]))
    try:
        yield
    finally:
        for process in started:
            process.terminate()
            process.wait()


async def view(port: int, rig: str, counts: list[int], number: int) -> None:
    """One viewer at 30 frames a second."""
    from websockets.asyncio.client import connect

    address = f"ws://127.0.0.1:{port}/api/v1/rigs/{rig}/stream"
    async with connect(address, max_size=None, ping_interval=None, open_timeout=60) as link:
        await link.recv()
        await link.send(json.dumps({"type": "subscribe", "rate_hz": 30}))
        async for _ in link:
            counts[number] += 1


def upload(port: int) -> None:
    """100 MB of CSV, sent as fast as they are taken."""
    head = (
        b'--b\r\nContent-Disposition: form-data; name="name"\r\n\r\nbig\r\n--b\r\n'
        b'Content-Disposition: form-data; name="file"; filename="big.csv"\r\n\r\ntime_s,yaw_deg,pitch_deg,roll_deg\n'
    )
    tail = b"\r\n--b--\r\n"
    rows = b"".join(b"%d.%03d,1.000000,2.000000,3.000000\n" % divmod(k, 1000) for k in range(100_000))
    repeats = UPLOAD_BYTES // len(rows)
    link = http.client.HTTPConnection("127.0.0.1", port, timeout=300)
    link.putrequest("POST", "/api/v1/trajectories")
    link.putheader("Content-Type", "multipart/form-data; boundary=b")
    link.putheader("Content-Length", str(len(head) + repeats * len(rows) + len(tail)))
    link.endheaders(head)
    with contextlib.suppress(OSError, http.client.HTTPException):
        for _ in range(repeats):
            link.send(rows)
        link.send(tail)
        # Refused in the end (its time repeats): what counts here is that it was sent and read.
        link.getresponse().read()
    link.close()


async def main() -> None:
    """View until the time is over, then say how many frames came."""
    arguments = argparse.ArgumentParser()
    arguments.add_argument("--port", type=int, required=True)
    arguments.add_argument("--rig", required=True)
    arguments.add_argument("--viewers", type=int, default=200)
    arguments.add_argument("--seconds", type=float, default=60.0)
    arguments.add_argument("--upload", action="store_true")
    given = arguments.parse_args()
    counts = [0] * given.viewers
    if given.upload:
        threading.Thread(target=upload, args=(given.port,), daemon=True).start()
    tasks = [asyncio.create_task(view(given.port, given.rig, counts, n)) for n in range(given.viewers)]
    await asyncio.sleep(given.seconds)
    for task in tasks:
        task.cancel()
    await asyncio.gather(*tasks, return_exceptions=True)
    print(
        f"viewers: {given.viewers}, {sum(counts) / max(1, given.viewers) / given.seconds:.1f} frames/s each", flush=True
    )


if __name__ == "__main__":
    asyncio.run(main())
