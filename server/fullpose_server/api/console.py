"""The console's files, built into the package; every path that is no file is the console's own route."""

from pathlib import Path

from starlette.exceptions import HTTPException
from starlette.responses import HTMLResponse, Response
from starlette.staticfiles import StaticFiles
from starlette.types import ASGIApp, Receive, Scope, Send

FOLDER = Path(__file__).resolve().parent.parent / "console"
API_PAGE = "/assets/api/"  # swagger-ui's files, as `web/vite.config.ts` puts them there
MISSING = """<!doctype html><html lang="en"><meta charset="utf-8"><title>Fullpose: no console</title>
<body style="font:16px/1.5 system-ui;max-width:40em;margin:4em auto">
<h1>The console is not built</h1>
<p>This server runs from a source tree without its console. Build it with <code>tools/setup</code>, or with
<code>npm ci &amp;&amp; npm run build</code> in <code>web/</code>.</p>
<p>The API works: see <a href="/api/v1/openapi.json">/api/v1/openapi.json</a>.</p>
"""


def console(folder: Path = FOLDER) -> ASGIApp:
    """The app at `/`."""
    return _Console(directory=folder) if (folder / "index.html").is_file() else _missing


class _Console(StaticFiles):
    async def get_response(self, path: str, scope: Scope) -> Response:
        try:
            response = await super().get_response(path, scope)
        except HTTPException as error:
            # Files are in assets/ or at the top with an ending; the rest are pages of the console, /operate/my.rig too.
            parts = Path(path).parts
            file = parts[:1] == ("assets",) or (len(parts) == 1 and "." in path)
            if error.status_code != 404 or path.startswith("api") or file:
                raise
            path, response = "index.html", await super().get_response("index.html", scope)
        if path in (".", "index.html"):
            response.headers["Cache-Control"] = "no-cache"
        elif path.startswith("assets/"):  # their names carry a hash of their content
            response.headers["Cache-Control"] = "public, max-age=31536000, immutable"
        return response

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        if scope["type"] == "websocket":
            await send({"type": "websocket.close", "code": 4404, "reason": "no such WebSocket"})
            return
        await super().__call__(scope, receive, send)


async def _missing(scope: Scope, receive: Receive, send: Send) -> None:
    if scope["type"] == "websocket":
        await send({"type": "websocket.close", "code": 4404, "reason": "no such WebSocket"})
        return
    if scope["path"].startswith("/api/"):
        raise HTTPException(404, f"no such path: {scope['path']}")
    await HTMLResponse(MISSING, status_code=503)(scope, receive, send)
