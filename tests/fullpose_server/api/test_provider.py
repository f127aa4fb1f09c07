"""Signing in at a provider, by a real one and a client that goes where it is sent, as a browser does."""

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import httpx
import pytest
from joserfc.jwk import ECKey
from pydantic import ValidationError

from fullpose_server.people.roles import Role
from fullpose_server.settings import Settings
from tests.fullpose_server.api.live_server import LiveServer, live_server
from tests.support.provider import CLIENT, SECRET, SmallProvider, small_provider

ANN = {"sub": "1", "preferred_username": "ann", "groups": ["staff", "fms-operators"]}
BOSS = {"sub": "2", "preferred_username": "boss", "groups": ["fms-operators", "fms-admins"]}


@pytest.fixture
def provider() -> Iterator[SmallProvider]:
    with small_provider() as provider:
        yield provider


@pytest.fixture
def server(tmp_path: Path, provider: SmallProvider) -> Iterator[LiveServer]:
    settings: dict[str, Any] = {
        "oidc_issuer": provider.issuer,
        "oidc_client_id": CLIENT,
        "oidc_client_secret": SECRET,
        "oidc_name": "the institute",
        "oidc_roles": {"fms-operators": "operator", "fms-admins": "admin"},
    }
    with live_server(tmp_path, **settings) as server:
        yield server


def browser(server: LiveServer) -> httpx.Client:
    """Keeps cookies and follows where it is sent."""
    return httpx.Client(base_url=f"{server.url}/api/v1", follow_redirects=True, timeout=60.0)


def sign_in(client: httpx.Client) -> httpx.Response:
    return client.get("/login/provider")


def who(client: httpx.Client) -> tuple[str, str] | None:
    person = client.get("/me").json()["person"]
    return None if person is None else (person["name"], person["role"])


def test_people_come_from_the_provider_with_the_role_that_it_says(server: LiveServer, provider: SmallProvider) -> None:
    with browser(server) as client, browser(server) as other:
        assert client.get("/me").json() == {"people": True, "person": None, "provider": "the institute"}
        assert client.get("/rigs").status_code == 401  # though nobody has ever signed in
        provider.signed_in = ANN
        arrived = sign_in(client)
        assert str(arrived.url) in (f"{server.url}/", f"{server.url}")
        assert who(client) == ("ann", "operator")
        assert client.get("/rigs").is_success
        provider.signed_in = BOSS
        sign_in(other)
        assert who(other) == ("boss", "admin")
        assert [user["name"] for user in other.get("/users").json()] == ["ann", "boss"]
        # Renamed there, and with another role: the same person here.
        provider.signed_in = ANN | {"preferred_username": "ann.married", "groups": ["fms-admins"]}
        sign_in(client)
        assert who(client) == ("ann", "admin")
        page = {"Origin": server.url}
        assert other.put("/users/ann", json={"disabled": True}, headers=page).is_success
        refused = sign_in(client)
        assert (refused.status_code, "let in no longer" in refused.text) == (403, True)
        assert who(client) is None


@pytest.mark.parametrize(
    ("claims", "status", "word"),
    [
        ({}, 401, "access_denied"),
        (ANN | {"groups": ["staff"]}, 403, "no groups of theirs has a role"),
        (ANN | {"groups": "fms-admins"} | {"preferred_username": None}, 502, "does not say preferred_username"),
        (ANN | {"preferred_username": "<script>x y"}, 403, "cannot be a name here"),
    ],
)
def test_who_has_no_place_here_is_told(
    server: LiveServer, provider: SmallProvider, claims: dict[str, Any], status: int, word: str
) -> None:
    provider.signed_in = claims
    with browser(server) as client:
        refused = sign_in(client)
        assert (refused.status_code, word in refused.text) == (status, True)
        assert "<script>" not in refused.text
        assert who(client) is None


@pytest.mark.parametrize(
    "twist",
    [
        {"iss": "http://127.0.0.1:1"},
        {"aud": "another"},
        {"nonce": "of another sign-in"},
        {"exp": 1_000_000_000},
        {"sub": None},
        {"azp": "another"},
    ],
)
def test_an_answer_that_does_not_hold_signs_nobody_in(
    server: LiveServer, provider: SmallProvider, twist: dict[str, Any]
) -> None:
    provider.signed_in, provider.twist = ANN, twist
    with browser(server) as client:
        assert sign_in(client).status_code == 502
        assert who(client) is None


def test_a_token_that_another_signed_signs_nobody_in(server: LiveServer, provider: SmallProvider) -> None:
    provider.signed_in = ANN
    provider.key = ECKey.generate_key("P-256", {"kid": "a"})
    with browser(server) as client:
        assert sign_in(client).status_code == 502
        assert who(client) is None


def test_a_provider_that_says_it_is_another_is_not_gone_to(server: LiveServer, provider: SmallProvider) -> None:
    provider.claims_to_be = "https://another.example"
    with browser(server) as client:
        assert "another.example" in sign_in(client).json()["detail"]


def test_an_answer_for_another_browser_or_used_before_signs_nobody_in(
    server: LiveServer, provider: SmallProvider
) -> None:
    provider.signed_in = ANN
    with browser(server) as client, browser(server) as victim:
        client.follow_redirects = False
        there = client.get("/login/provider").headers["location"]
        back = httpx.get(there).headers["location"]
        assert victim.get(back).status_code == 401  # login CSRF: no cookie of this sign-in
        assert who(victim) is None
        spoilt = client.get(back.replace("state=", "state=x"))
        assert spoilt.status_code == 401
        assert client.get(back).status_code == 401  # once, whatever came of it
        assert who(client) is None


def test_a_name_that_is_another_persons_is_not_taken(server: LiveServer, provider: SmallProvider) -> None:
    provider.signed_in = ANN
    with browser(server) as client, browser(server) as impostor:
        sign_in(client)
        provider.signed_in = ANN | {"sub": "3"}
        refused = sign_in(impostor)
        assert (refused.status_code, "there is a user ann already" in refused.text) == (409, True)
        assert who(impostor) is None
        assert who(client) == ("ann", "operator")


def test_a_provider_that_is_not_there_is_said(tmp_path: Path) -> None:
    settings = {"oidc_issuer": "http://127.0.0.1:9", "oidc_client_id": CLIENT}
    with live_server(tmp_path, **settings) as server, browser(server) as client:
        answer = sign_in(client)
    assert (answer.status_code, "does not answer" in answer.text) == (502, True)


@pytest.mark.parametrize(
    ("settings", "word"),
    [
        ({"oidc_issuer": "http://id.example"}, "oidc_client_id"),
        ({"oidc_issuer": "http://id.example", "oidc_client_id": "x"}, "https"),
        ({"oidc_issuer": "id.example", "oidc_client_id": "x"}, "pattern"),
        ({"oidc_roles": {"a": "king"}}, "viewer"),
    ],
)
def test_settings_that_cannot_be_are_refused(settings: dict[str, Any], word: str) -> None:
    with pytest.raises(ValidationError, match=word):
        Settings(**settings)


def test_the_secret_is_in_no_words_about_the_settings() -> None:
    settings = Settings(oidc_issuer="https://id.example", oidc_client_id="x", oidc_client_secret=SECRET)  # type: ignore[arg-type]
    assert SECRET not in repr(settings)
    assert settings.oidc_roles == {}
    assert Settings(oidc_default_role=Role.VIEWER).oidc_default_role is Role.VIEWER
