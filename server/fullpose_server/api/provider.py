"""Signing in at a provider: OpenID Connect's code flow with PKCE (OpenID Connect Core 1.0, section 3.1; RFC 7636).

What is remembered between the browser's leaving and its return is in memory, under a secret that the browser has in a
cookie: an answer that another browser was given signs nobody in (login CSRF).
"""

import asyncio
import time
from collections import OrderedDict
from dataclasses import dataclass
from importlib.util import find_spec
from typing import Any, NamedTuple, Self

from fullpose_server.api.problems import ApiError
from fullpose_server.errors import ServerError
from fullpose_server.people.roles import Role
from fullpose_server.secret import new_secret, proof_of
from fullpose_server.settings import Settings

PENDING_S = 600.0  # that a person may take over there
_MOST = 1000  # on their way at once; of more the oldest begins anew
_TIMEOUT_S = 10.0
_KEPT_S = 300.0  # the description of the provider: strangers may ask to be sent there as often as they like
_LEEWAY_S = 60  # between their clock and ours
# Signatures that only the provider can make; never none, nor one by a shared secret.
_SIGNED_BY = ("RS256", "RS384", "RS512", "PS256", "PS384", "PS512", "ES256", "ES384", "ES512", "EdDSA", "Ed25519")


class Leaving(NamedTuple):
    """Where a browser is sent, and the secret that it brings back in a cookie."""

    address: str
    secret: str


class Arrived(NamedTuple):
    """Who came back: `subject` is who they are to the provider, for ever; `name` what they are called here."""

    subject: str
    name: str
    role: Role


@dataclass(frozen=True)
class _Pending:
    state: str
    nonce: str
    verifier: str
    back: str
    until: float


class Provider:
    """The provider of a server's settings. Belongs to the event loop's thread."""

    def __init__(self, settings: Settings, issuer: str) -> None:
        self._settings = settings
        self._issuer = issuer
        self._described: tuple[float, dict[str, Any]] | None = None  # until when, and how
        self._pending: OrderedDict[str, _Pending] = OrderedDict()  # by the proof of the cookie's secret

    @classmethod
    def of(cls, settings: Settings) -> Self | None:
        """The provider; None where there is none. Raises `ServerError` where what it takes is not installed."""
        if settings.oidc_issuer is not None and find_spec("authlib") is None:
            raise ServerError("oidc_issuer is set, which takes more packages: pip install 'fullpose[oidc]'")
        return None if settings.oidc_issuer is None else cls(settings, settings.oidc_issuer)

    async def leave(self, back: str) -> Leaving:
        """Send a browser there; it returns to the address `back`. Raises `ApiError` where the provider is not there."""
        pending = _Pending(new_secret(), new_secret(), new_secret(), back, time.monotonic() + PENDING_S)
        address = await asyncio.to_thread(self._address, pending)
        secret = new_secret()
        self._pending[proof_of(secret)] = pending
        while len(self._pending) > _MOST:
            self._pending.popitem(last=False)
        return Leaving(address, secret)

    async def arrive(self, secret: str | None, query: dict[str, str]) -> Arrived:
        """Who came back with this answer and this cookie; once. Raises `ApiError`."""
        pending = self._pending.pop(proof_of(secret), None) if secret else None
        if pending is None or time.monotonic() > pending.until or query.get("state") != pending.state:
            raise ApiError(401, "login", "this sign-in was not begun here, or too long ago: begin anew")
        if "error" in query or "code" not in query:
            word = query.get("error", "no code")[:100]
            raise ApiError(401, "login", f"{self._settings.oidc_name} did not sign you in: {word}")
        return self._person(await asyncio.to_thread(self._claims, pending, query["code"]))

    # --- in a thread: the provider takes its time, and so do the imports ---

    def _address(self, pending: _Pending) -> str:
        with self._client(pending.back) as client:
            endpoint = self._metadata(client)["authorization_endpoint"]
            address, _ = client.create_authorization_url(
                endpoint, state=pending.state, nonce=pending.nonce, code_verifier=pending.verifier
            )
        return str(address)

    def _claims(self, pending: _Pending, code: str) -> dict[str, Any]:
        import httpx2
        from authlib.common.errors import AuthlibBaseError
        from authlib.oidc.core import CodeIDToken
        from joserfc import jwt
        from joserfc.errors import JoseError
        from joserfc.jwk import KeySet

        with self._client(pending.back) as client:
            metadata = self._metadata(client)
            try:
                given = client.fetch_token(metadata["token_endpoint"], code=code, code_verifier=pending.verifier)
                found: Any = self._json(client, metadata["jwks_uri"])
                keys = KeySet.import_key_set(found)
                allowed = [a for a in metadata.get("id_token_signing_alg_values_supported", ()) if a in _SIGNED_BY]
                token = jwt.decode(given["id_token"], keys, algorithms=allowed or ["RS256"])
                client_id = self._settings.oidc_client_id
                claims = CodeIDToken(
                    token.claims,
                    token.header,
                    {"iss": {"essential": True, "value": self._issuer}, "aud": {"essential": True, "value": client_id}},
                    {"nonce": pending.nonce, "client_id": client_id, "access_token": given.get("access_token")},
                )
                claims.validate(leeway=_LEEWAY_S)
            except (AuthlibBaseError, JoseError, KeyError, ValueError) as error:
                raise self._untrue(f"its answer does not hold ({type(error).__name__})") from error
            except httpx2.HTTPError as error:
                raise self._untrue(f"it does not answer ({type(error).__name__})") from error
        return dict(claims)

    def _person(self, claims: dict[str, Any]) -> Arrived:
        settings = self._settings
        name = claims.get(settings.oidc_name_claim)
        if not isinstance(name, str) or not name:
            raise self._untrue(f"it does not say {settings.oidc_name_claim}")
        told = claims.get(settings.oidc_role_claim, [])
        words = told if isinstance(told, list) else [told]
        roles = [settings.oidc_roles[word] for word in words if isinstance(word, str) and word in settings.oidc_roles]
        role = max(roles, key=list(Role).index) if roles else settings.oidc_default_role
        if role is None:
            told = f"{name} may not sign in here: no {settings.oidc_role_claim} of theirs has a role"
            raise ApiError(403, "role", told)
        return Arrived(f"{self._issuer}#{claims['sub']}", name, role)

    def _client(self, back: str) -> Any:
        from authlib.integrations.httpx_client import OAuth2Client

        settings = self._settings
        secret = settings.oidc_client_secret
        return OAuth2Client(
            settings.oidc_client_id,
            None if secret is None else secret.get_secret_value(),
            scope=settings.oidc_scope,
            redirect_uri=back,
            code_challenge_method="S256",
            timeout=_TIMEOUT_S,
        )

    def _metadata(self, client: Any) -> dict[str, Any]:
        """The provider's own description, kept for a while. Raises `ApiError` where it is another's, or none."""
        import httpx2

        described = self._described
        if described is not None and time.monotonic() < described[0]:
            return described[1]
        try:
            found = self._json(client, f"{self._issuer.rstrip('/')}/.well-known/openid-configuration")
        except (httpx2.HTTPError, ValueError) as error:
            raise self._untrue(f"it does not answer ({type(error).__name__})") from error
        if found.get("issuer") != self._issuer:
            raise self._untrue(f"it says that it is {str(found.get('issuer'))[:100]!r}, not {self._issuer!r}")
        self._described = (time.monotonic() + _KEPT_S, found)
        return found

    @staticmethod
    def _json(client: Any, address: str) -> dict[str, Any]:
        found: dict[str, Any] = client.request("GET", address, withhold_token=True).raise_for_status().json()
        return found

    def _untrue(self, why: str) -> ApiError:
        return ApiError(502, "provider", f"{self._settings.oidc_name} cannot sign anybody in: {why}")
