"""Signing in at an OpenID provider, in a real browser that goes there and comes back."""

import json
import subprocess
from collections.abc import Iterator
from pathlib import Path

import pytest
from playwright.sync_api import expect

from fullpose_server.people.admitted import COOKIE
from tests.e2e.conftest import FULLPOSE, Pages, Server, serving
from tests.e2e.console import SOON_MS
from tests.e2e.test_people import estop_in_sight, menu, person_of, seen
from tests.support.provider import CLIENT, SECRET, SmallProvider, small_provider
from tests.support.repository import ROOT

pytestmark = pytest.mark.browser

ANN = {"sub": "1", "preferred_username": "ann", "groups": ["staff", "fms-operators"]}
STRANGER = {"sub": "2", "preferred_username": "sam", "groups": ["staff"]}


@pytest.fixture(scope="module")
def provider() -> Iterator[SmallProvider]:
    with small_provider() as provider:
        yield provider


@pytest.fixture(scope="module")
def data(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("provided")


@pytest.fixture(scope="module")
def server(data: Path, provider: SmallProvider) -> Iterator[Server]:
    settings = {
        "FULLPOSE_OIDC_ISSUER": provider.issuer,
        "FULLPOSE_OIDC_CLIENT_ID": CLIENT,
        "FULLPOSE_OIDC_CLIENT_SECRET": SECRET,
        "FULLPOSE_OIDC_NAME": "the institute",
        "FULLPOSE_OIDC_ROLES": json.dumps({"fms-operators": "operator"}),
    }
    with serving(data, **settings) as running:
        yield running


def test_one_signs_in_at_the_provider_and_comes_back_to_where_one_was(
    pages: Pages, server: Server, provider: SmallProvider, data: Path, shots: Path
) -> None:
    pages.elsewhere.append(f"{provider.issuer}/")
    page = pages.open()
    page.goto("/alarms")
    button = page.get_by_role("link", name="Sign in with the institute")
    expect(button).to_be_visible(timeout=SOON_MS)
    seen(page, shots, "provider-sign-in")
    provider.signed_in = STRANGER
    button.click()
    expect(page.locator("body")).to_contain_text("role", timeout=SOON_MS)
    page.screenshot(path=shots / "provider-refused.png")
    assert COOKIE not in {each["name"] for each in page.context.cookies()}

    provider.signed_in = ANN
    page.goto("/alarms")
    button.click()
    expect(person_of(page)).to_contain_text("ann", timeout=SOON_MS)
    expect(page.get_by_role("heading", name="Alarms")).to_be_visible(timeout=SOON_MS)
    assert page.url == f"{server.url}/alarms"  # no code, no state is left in it
    estop_in_sight(page)
    seen(page, shots, "provider-signed-in")
    (cookie,) = (each for each in page.context.cookies(server.url) if each["name"] == COOKIE)
    assert cookie["httpOnly"]
    assert cookie["sameSite"] in ("Lax", "Strict")
    assert page.evaluate("document.cookie") == ""

    menu(page, "Sign out")
    expect(button).to_be_visible(timeout=SOON_MS)
    button.click()
    expect(person_of(page)).to_contain_text("ann", timeout=SOON_MS)
    out = [*FULLPOSE, "user", "disable", "ann", "--data-dir", str(data)]
    subprocess.run(out, cwd=ROOT, check=True, capture_output=True)
    expect(button).to_be_visible(timeout=SOON_MS)  # shut out at once, whatever the provider says
    button.click()
    expect(page.locator("body")).to_contain_text("let in no longer", timeout=SOON_MS)
