"""A small OpenID provider, as the specification has it: for tests, on loopback, with keys of its own."""

import base64
import hashlib
import secrets
import socket
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any
from urllib.parse import urlencode

import uvicorn
from joserfc import jwt
from joserfc.jwk import ECKey, KeySet
from starlette.applications import Starlette
from starlette.requests import Request
from starlette.responses import JSONResponse, RedirectResponse, Response
from starlette.routing import Route

CLIENT, SECRET = "fullpose", "the client's secret"


class SmallProvider:
    """`signed_in`: the claims of who sits before the browser; `twist` may spoil a token before it is signed."""

    def __init__(self, issuer: str) -> None:
        self.issuer = issuer
        self.signed_in: dict[str, Any] = {}
        self.twist: dict[str, Any] = {}
        self.key = self.shown_key = ECKey.generate_key("P-256", {"kid": "a", "alg": "ES256", "use": "sig"})
        self.claims_to_be = issuer
        self._codes: dict[str, dict[str, str]] = {}

    def app(self) -> Starlette:
        """The provider, to be served."""
        return Starlette(
            routes=[
                Route("/.well-known/openid-configuration", self._configuration),
                Route("/authorize", self._authorize),
                Route("/token", self._token, methods=["POST"]),
                Route("/jwks", self._jwks),
            ]
        )

    async def _configuration(self, _request: Request) -> Response:
        return JSONResponse(
            {
                "issuer": self.claims_to_be,
                "authorization_endpoint": f"{self.issuer}/authorize",
                "token_endpoint": f"{self.issuer}/token",
                "jwks_uri": f"{self.issuer}/jwks",
                "id_token_signing_alg_values_supported": ["ES256", "HS256", "none"],
            }
        )

    async def _authorize(self, request: Request) -> Response:
        asked = dict(request.query_params)
        back = {"state": asked["state"]}
        if not self.signed_in:
            back["error"] = "access_denied"
        else:
            code = secrets.token_urlsafe()
            self._codes[code] = asked
            back["code"] = code
        return RedirectResponse(f"{asked['redirect_uri']}?{urlencode(back)}", 302)

    async def _token(self, request: Request) -> Response:
        form = await request.form()
        asked = self._codes.pop(str(form["code"]), None)
        basic = base64.b64encode(f"{CLIENT}:{SECRET}".encode()).decode()
        digest = hashlib.sha256(str(form["code_verifier"]).encode()).digest()
        challenge = base64.urlsafe_b64encode(digest).rstrip(b"=").decode()
        if (
            asked is None
            or request.headers["authorization"] not in (f"Basic {basic}", f"Basic {_quoted()}")
            or asked["code_challenge"] != challenge
            or asked["code_challenge_method"] != "S256"
            or form["redirect_uri"] != asked["redirect_uri"]
        ):
            return JSONResponse({"error": "invalid_grant"}, 400)
        now = int(time.time())
        base = {"iss": self.issuer, "aud": CLIENT, "iat": now, "exp": now + 300, "nonce": asked["nonce"]}
        token = jwt.encode({"alg": "ES256", "kid": "a"}, base | self.signed_in | self.twist, self.key)
        return JSONResponse({"access_token": "a", "token_type": "Bearer", "id_token": token})

    async def _jwks(self, _request: Request) -> Response:
        return JSONResponse(KeySet([self.shown_key]).as_dict(private=False))


def _quoted() -> str:
    """RFC 6749, 2.3.1: name and secret are form-encoded first, as some clients do and others do not."""
    from urllib.parse import quote_plus

    return base64.b64encode(f"{quote_plus(CLIENT)}:{quote_plus(SECRET)}".encode()).decode()


@contextmanager
def small_provider() -> Iterator[SmallProvider]:
    """One that is served."""
    listener = socket.create_server(("127.0.0.1", 0))
    provider = SmallProvider(f"http://127.0.0.1:{listener.getsockname()[1]}")
    server = uvicorn.Server(uvicorn.Config(provider.app(), log_config=None, lifespan="off"))
    thread = threading.Thread(target=server.run, kwargs={"sockets": [listener]}, name="provider")
    thread.start()
    try:
        yield provider
    finally:
        server.should_exit = True
        thread.join()
        listener.close()
