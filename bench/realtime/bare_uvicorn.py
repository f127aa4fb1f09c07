"""A bare uvicorn, measured beside the server in the same run: what the machine makes of an answer at that moment."""

import contextlib
import socket
import subprocess
import sys
import time
from collections.abc import Iterator

_PROGRAM = """
import asyncio, uvicorn
from fullpose_server.gate.system import SERVER, before_others
async def app(scope, receive, send):
    body = b"x" * int(scope["path"][1:] or 2)
    headers = [(b"content-length", str(len(body)).encode())]
    await send({"type": "http.response.start", "status": 200, "headers": headers})
    await send({"type": "http.response.body", "body": body})
before_others(SERVER)
uvicorn.run(app, port=%d, log_level="error", lifespan="off")
"""


@contextlib.contextmanager
def bare_server() -> Iterator[int]:
    """It answers / with two bytes, and /N with N; its port."""
    with socket.create_server(("127.0.0.1", 0)) as free:
        port = free.getsockname()[1]
    process = subprocess.Popen([sys.executable, "-c", _PROGRAM % port])
    try:
        while True:
            with contextlib.suppress(OSError), socket.create_connection(("127.0.0.1", port), timeout=1):
                break
            time.sleep(0.05)
        yield port
    finally:
        process.terminate()
        process.wait(10)
