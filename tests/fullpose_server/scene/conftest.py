"""A real viser server behind a real HTTP server, both on loopback."""

import socket
import threading
from collections.abc import Iterator
from dataclasses import dataclass

import pytest
import uvicorn
from fastapi import FastAPI

from fullpose.rig import builtin_rigs
from fullpose_server.formats.rig_file import Payload
from fullpose_server.scene.proxy import router
from fullpose_server.scene.scenes import SceneServer


@dataclass
class Served:
    """What a test works with."""

    scenes: SceneServer
    address: str  # host:port of the HTTP server


@pytest.fixture
def scenes() -> Iterator[SceneServer]:
    server = SceneServer()
    yield server
    server.close()


@pytest.fixture
def served(scenes: SceneServer) -> Iterator[Served]:
    """`vertical-4` started and proxied by uvicorn."""
    scenes.start(builtin_rigs()["vertical-4"], Payload(), "vertical-4")
    app = FastAPI()
    app.state.scenes = scenes
    app.include_router(router)
    with socket.socket() as listening:
        listening.bind(("127.0.0.1", 0))
        listening.listen()  # so that who connects before uvicorn is up waits instead of being refused
        config = uvicorn.Config(app, log_level="warning", ws="websockets-sansio", lifespan="off")
        server = uvicorn.Server(config)
        thread = threading.Thread(target=server.run, kwargs={"sockets": [listening]})
        thread.start()
        yield Served(scenes, f"127.0.0.1:{listening.getsockname()[1]}")
        server.should_exit = True
        thread.join()
