"""The server's event loop: the app's lifespan, uvicorn on a socket that is bound already, and an orderly end."""

import asyncio
import contextlib
import gc
import signal
import socket
import sys
import threading
from collections.abc import Awaitable, Callable, Iterator

import uvicorn
import uvloop

from fullpose_server.api.deps import Services
from fullpose_server.app import create_app
from fullpose_server.cli._exit import CommandError, fail
from fullpose_server.errors import ServerError
from fullpose_server.gate.keeper import GateProcess, Keeper
from fullpose_server.gate.served import Connections, served_by
from fullpose_server.gate.system import SERVER, before_others, files
from fullpose_server.runtime.supervisor.errors import HostError
from fullpose_server.scene.scenes import prewarm
from fullpose_server.settings import Settings

Ready = Callable[[str], Awaitable[None]]
PREWARM_AFTER_S = 0.5
# How long a thread that computes (reading an upload) may keep the interpreter from the event loop, at every single
# send. Python's own 5 ms are half of what an E-stop may take.
SWITCH_S = 0.0001
FILES_KEPT = 192  # of those this process may have open: for its own, and three pipes or so a rig


def serve(settings: Settings, listener: socket.socket, url: str, ready: Ready) -> None:
    """Serve on `listener` until SIGINT or SIGTERM; the address is the first line of stdout."""
    sys.setswitchinterval(SWITCH_S)
    before_others(SERVER)
    try:
        with asyncio.Runner(loop_factory=uvloop.new_event_loop) as runner:
            runner.run(_run(settings, listener, url, ready))
    except ServerError as error:
        fail(str(error))
    except (HostError, CommandError) as error:
        fail(str(error), 1)


def _prewarm() -> None:
    prewarm()
    # What has been loaded stays: without this each full collection looks at all of it again, and nothing else runs for
    # the 120 ms that takes.
    gc.freeze()


async def _run(settings: Settings, listener: socket.socket, url: str, ready: Ready) -> None:
    gate = GateProcess.spawn(listener, settings.log, settings.trusted_proxies)  # it loads while the server does
    app = create_app(settings)
    config = served_by(
        app,
        timeout_graceful_shutdown=3,
        ws_max_size=settings.max_message_bytes,
        forwarded_allow_ips=list(settings.trusted_proxies),
    )
    keeper: Keeper | None = None
    try:
        async with app.router.lifespan_context(app):
            server = _Server(config)
            services: Services = app.state.services
            served, most = Connections(config, server.server_state), min(settings.max_connections, files() - FILES_KEPT)
            keeper = Keeper(listener, gate, served, most, services)
            serving = asyncio.create_task(server.serve(sockets=[]))  # none of its own: the gate has it
            sys.stdout.write(f"{url}\n")
            sys.stdout.flush()
            # What the first look at a scene needs is loaded when the server has begun to answer: nobody waits for it.
            warming = threading.Thread(target=_prewarm, name="scene-prewarm", daemon=True)
            later = asyncio.get_running_loop().call_later(PREWARM_AFTER_S, warming.start)
            beside = asyncio.create_task(_beside(ready, url, server))
            await serving
            keeper.ending()  # while the rigs brake they can still be stopped
            later.cancel()
            beside.cancel()
            results = await asyncio.gather(beside, return_exceptions=True)
    finally:
        await (gate.end() if keeper is None else keeper.close())
    for result in results:
        if isinstance(result, Exception):
            raise result


async def _beside(ready: Ready, url: str, server: uvicorn.Server) -> None:
    try:
        await ready(url)
    except Exception:
        if not server.should_exit:  # at the end every connection of ours breaks off too
            server.should_exit = True
            raise


class _Server(uvicorn.Server):
    """Ends at a signal without raising it again afterwards: what follows is our own orderly end."""

    @contextlib.contextmanager
    def capture_signals(self) -> Iterator[None]:
        loop = asyncio.get_running_loop()
        for number in (signal.SIGINT, signal.SIGTERM):
            loop.add_signal_handler(number, self.handle_exit, number, None)
        try:
            yield
        finally:
            for number in (signal.SIGINT, signal.SIGTERM):
                loop.remove_signal_handler(number)
                # The end has begun; a second signal must not cut it short and leave a rig moving.
                signal.signal(number, signal.SIG_IGN)
