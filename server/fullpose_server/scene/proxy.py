"""`/scene/{rig}/`: the rig's viser server behind the same port and login as everything else.

The app keeps its `SceneServer` in `app.state.scenes` and includes `router`; login and the Origin check are that
inclusion's dependencies. viser's page finds its WebSocket from its own address, so a path in front of it is enough.
"""

import asyncio
import http.client
import socket as sockets
from urllib.parse import quote, urlsplit

import anyio
import websockets
from fastapi import APIRouter, Request, Response, WebSocket
from fastapi.responses import PlainTextResponse, RedirectResponse
from starlette.requests import HTTPConnection
from starlette.websockets import WebSocketDisconnect
from websockets.asyncio.client import ClientConnection, unix_connect
from websockets.typing import Subprotocol

from fullpose_server.runtime.contract.rig_paths import SocketAddress
from fullpose_server.scene.errors import UnknownSceneError
from fullpose_server.scene.scenes import SceneServer

router = APIRouter(include_in_schema=False)

# viser has no setting that removes its control panel, which here would be an empty box over the view; nor its notice
# about drawing without a graphics card, which the console gives in its own words.
HIDE_CHROME = b"<style>.mantine-Paper-root,#webgl-software-rendering{display:none!important}</style>"
PASSED_BACK = ("content-type", "cache-control", "etag", "last-modified")
LONGEST, LONGEST_PART = 1024, 255  # [bytes] of a path in a scene: viser takes it for a file, and fails at a longer one
QUEUE = 8  # messages held for a slow browser; behind them, TCP makes viser itself wait and merge
MESSAGE_BYTES = 64 * 1024 * 1024


class _Scene(http.client.HTTPConnection):
    """To a scene's own socket."""

    def __init__(self, address: SocketAddress) -> None:
        super().__init__("scene", timeout=10.0)
        self._address = address

    def connect(self) -> None:
        self.sock = sockets.socket(sockets.AF_UNIX, sockets.SOCK_STREAM)
        self.sock.settimeout(self.timeout)
        with self._address as path:
            self.sock.connect(path)


def _address(connection: HTTPConnection, rig: str) -> SocketAddress | None:
    scenes: SceneServer = connection.app.state.scenes
    try:
        return scenes.address(rig)
    except UnknownSceneError:
        return None


def _foreign(connection: HTTPConnection) -> bool:
    """Whether the address sends viser's page elsewhere for its scene, which would run under our origin."""
    query = connection.query_params
    if "playbackPath" in query:
        return True
    return any(urlsplit(server).netloc != connection.headers.get("host") for server in query.getlist("websocket"))


@router.get("/scene/{rig}")
def with_slash(request: Request, rig: str) -> RedirectResponse:
    """viser's page needs the slash to find its WebSocket."""
    query = f"?{request.url.query}" if request.url.query else ""
    return RedirectResponse(f"/scene/{rig}/{query}", status_code=307)


@router.get("/scene/{rig}/{path:path}")
async def page(request: Request, rig: str, path: str) -> Response:
    """Forward a GET to the rig's viser server."""
    address = _address(request, rig)
    if address is None:
        return PlainTextResponse(f"no scene {rig!r} is running\n", status_code=404)
    if len(path.encode()) > LONGEST or any(len(part.encode()) > LONGEST_PART for part in path.split("/")):
        return PlainTextResponse("nothing of a scene has so long a name\n", status_code=404)
    if _foreign(request):
        return PlainTextResponse("a scene is shown from this server only\n", status_code=400)
    try:
        status, headers, body = await anyio.to_thread.run_sync(_get, address, "/" + quote(path))
    except (OSError, http.client.HTTPException):
        return PlainTextResponse(f"the scene of {rig!r} does not answer\n", status_code=502)
    if headers.get("content-type", "").startswith("text/html"):
        body = body.replace(b"</head>", HIDE_CHROME + b"</head>", 1)
    passed = {name: headers[name] for name in PASSED_BACK if name in headers}
    passed["content-security-policy"] = "frame-ancestors 'self'"
    return Response(body, status, passed)


def _get(address: SocketAddress, path: str) -> tuple[int, dict[str, str], bytes]:
    connection = _Scene(address)
    try:
        connection.request("GET", path, headers={"Accept-Encoding": "identity"})
        answer = connection.getresponse()
        return answer.status, {name.lower(): value for name, value in answer.getheaders()}, answer.read()
    finally:
        connection.close()


@router.websocket("/scene/{rig}")
@router.websocket("/scene/{rig}/")
async def socket(browser: WebSocket, rig: str) -> None:
    """Join the browser's WebSocket to the rig's viser server, subprotocol and frames as they are.

    viser's page asks for its own address without the slash at the end.
    """
    address = _address(browser, rig)
    if address is None:
        await browser.close(4404, f"no scene {rig!r} is running")
        return
    offered = [Subprotocol(name) for name in browser.scope.get("subprotocols", [])]
    try:
        with address as path:
            viser = await unix_connect(
                path, subprotocols=offered or None, compression=None, max_size=MESSAGE_BYTES, max_queue=QUEUE
            )
    except (OSError, websockets.InvalidHandshake, TimeoutError):
        await browser.close(4502, f"the scene of {rig!r} does not answer")
        return
    async with viser:
        await browser.accept(subprotocol=viser.subprotocol)
        down = asyncio.create_task(_down(viser, browser))
        up = asyncio.create_task(_up(browser, viser))
        try:
            await asyncio.wait((down, up), return_when=asyncio.FIRST_COMPLETED)
        finally:
            for task in (down, up):
                task.cancel()
            ends = await asyncio.gather(down, up, return_exceptions=True)
    for end in ends:
        if isinstance(end, Exception) and not isinstance(end, (WebSocketDisconnect, websockets.ConnectionClosed)):
            raise end


async def _down(viser: ClientConnection, browser: WebSocket) -> None:
    async for message in viser:
        if isinstance(message, str):
            await browser.send_text(message)
        else:
            await browser.send_bytes(message)
    await browser.close(1001)


async def _up(browser: WebSocket, viser: ClientConnection) -> None:
    while True:
        message = await browser.receive()
        if message["type"] == "websocket.disconnect":
            return
        data = message.get("bytes")
        await viser.send(message["text"] if data is None else data)
