"""People at the console: who signs in, what a role forbids, and who is shut out is shown the sign-in page at once."""

import re
import subprocess
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import get_args

import httpx
import pytest
from playwright.sync_api import Locator, Page, ViewportSize, expect

from tests.e2e.conftest import FULLPOSE, PATIENT_MS, TABLET, Pages, Server, serving
from tests.e2e.console import SOON_MS, Console
from tests.e2e.test_pages import CUT_TABLES, LOW_CONTRAST, Theme
from tests.support.repository import ROOT

pytestmark = pytest.mark.browser

RIG = "hall"
# A page in the background of a starved machine is long silent, and others could take what it holds.
HALL = f'name = "{RIG}"\ngeometry = "vertical-4"\n[silence.owner]\nhold_s = 300.0\nstop_s = 400.0\ndisarm_s = 500.0\n'
PHONE: ViewportSize = {"width": 360, "height": 740}
PASSWORD = "a sentence that nobody guesses"
PEOPLE = {"ola": "operator", "vic": "viewer", "eve": "operator"}
OUT = "is signed in no longer"


@pytest.fixture(scope="module")
def server(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Server]:
    """A server of people: its first admin made on the command line, the others by that one."""
    data = tmp_path_factory.mktemp("people")
    add = [*FULLPOSE, "user", "add", "ada", "--role", "admin", "--password-stdin", "--data-dir", str(data)]
    subprocess.run(add, cwd=ROOT, input=f"{PASSWORD}\n", text=True, check=True, capture_output=True)
    (data / "rigs").mkdir()
    (data / "rigs" / f"{RIG}.toml").write_text(HALL, encoding="utf-8")
    with serving(data) as running:
        with api_of(running, "ada") as ada:
            for name, role in PEOPLE.items():
                person = {"name": name, "role": role, "password": PASSWORD}
                ada.post("/users", json=person).raise_for_status()
        yield running


@contextmanager
def api_of(server: Server, name: str) -> Iterator[httpx.Client]:
    """The API, as who has signed in there."""
    origin = {"Origin": server.url}
    with httpx.Client(base_url=f"{server.url}/api/v1", headers=origin, timeout=PATIENT_MS / 1000.0) as client:
        client.post("/login", json={"name": name, "password": PASSWORD}).raise_for_status()
        yield client


def sign_in(page: Page, name: str, password: str = PASSWORD) -> None:
    page.get_by_label("Name").fill(name)
    page.get_by_label("Password").fill(password)
    page.get_by_label("Password").press("Enter")


def signed_in(pages: Pages, name: str, address: str, viewport: ViewportSize | None = None) -> Page:
    """A browser of its own, of a person who has signed in and is where the address says."""
    page = pages.open(viewport=viewport) if viewport else pages.open()
    page.goto(address)
    sign_in(page, name)
    expect(person_of(page)).to_contain_text(name, timeout=SOON_MS)
    return page


def person_of(page: Page) -> Locator:
    return page.get_by_role("button", name=re.compile("^Signed in:"))


def menu(page: Page, item: str) -> None:
    person_of(page).click()
    page.get_by_role("group", name="Person").get_by_text(item, exact=True).click()


def seen(page: Page, shots: Path, name: str) -> None:
    """In both themes and as wide as it is: legible, and nothing sticks out."""
    for theme in get_args(Theme):
        page.emulate_media(color_scheme=theme)
        expect(page.locator("html")).to_have_attribute("data-theme", theme)
        page.evaluate("Promise.all(document.getAnimations().map((each) => each.finished.catch(() => null)))")
        assert page.evaluate(LOW_CONTRAST) == [], (name, theme)
        page.screenshot(path=shots / f"people-{name}-{theme}.png")
    assert page.evaluate("document.documentElement.scrollWidth <= innerWidth"), name
    assert page.evaluate(CUT_TABLES) == [], name


def estop_in_sight(page: Page) -> None:
    box, size = page.get_by_role("button", name="E-stop").bounding_box(), page.viewport_size
    assert box is not None
    assert size is not None
    assert box["x"] + box["width"] <= size["width"]
    assert box["y"] >= 0


def test_one_signs_in_before_anything_else_is_asked_for(pages: Pages, shots: Path) -> None:
    page = pages.open()
    asked: list[str] = []
    page.on("request", lambda sent: asked.append(sent.url) if "/api/" in sent.url or "/scene/" in sent.url else None)
    page.on("websocket", lambda socket: asked.append(socket.url))
    page.goto("/alarms")
    expect(page.get_by_label("Name")).to_be_focused(timeout=SOON_MS)
    seen(page, shots, "sign-in")
    sign_in(page, "vic", "not the password")
    expect(page.get_by_role("alert")).to_contain_text("no such name with this password", timeout=SOON_MS)
    page.wait_for_timeout(1000)  # whatever would be asked for by a clock
    assert {url.split("/api/v1")[1] for url in asked} == {"/me", "/login"}
    page.set_viewport_size(PHONE)
    seen(page, shots, "sign-in-phone")
    sign_in(page, "vic")
    expect(page.get_by_role("heading", name="Alarms")).to_be_visible(timeout=SOON_MS)
    assert page.url.endswith("/alarms")
    for viewport in (PHONE, TABLET):
        page.set_viewport_size(viewport)
        estop_in_sight(page)
    expect(page.get_by_role("link", name="People")).to_have_count(0)


def test_a_viewer_sees_and_stops_and_commands_nothing(pages: Pages, server: Server, shots: Path) -> None:
    with api_of(server, "ola") as ola:
        lease = ola.post(f"/rigs/{RIG}/lease", json={"action": "take"}).raise_for_status().json()
        shown = {"epoch": lease["epoch"], "sequence": 1, "secret": lease["secret"]}
        ola.post(f"/rigs/{RIG}/commands", json={"command": "connect", "lease": shown}).raise_for_status()
        ola.post(f"/rigs/{RIG}/lease", json={"action": "release", "secret": lease["secret"]}).raise_for_status()
    viewer = Console(signed_in(pages, "vic", f"/operate/{RIG}"), RIG)
    viewer.expect_state("idle")
    take = viewer.page.get_by_role("button", name="Take control")
    expect(take).to_have_attribute("title", "Your role is viewer")
    for button in (take, viewer.button("load"), viewer.page.get_by_role("button", name="Plan", exact=True)):
        expect(button).to_be_disabled()
    expect(viewer.page.get_by_label("Flight file")).to_be_disabled()
    seen(viewer.page, shots, "viewer")
    viewer.page.get_by_role("button", name="E-stop").click()
    viewer.expect_state("estopped")


def test_control_is_one_windows_and_given_up_by_who_signs_out(pages: Pages, server: Server, shots: Path) -> None:
    first = signed_in(pages, "eve", f"/operate/{RIG}")
    Console(first, RIG).take_control()
    second = first.context.new_page()
    Console(second, RIG).open()
    here, there = first.get_by_test_id("lease"), second.get_by_test_id("lease")
    expect(there).to_contain_text("Your other window", timeout=SOON_MS)
    expect(there).to_have_attribute("data-held", "false")
    second.get_by_role("button", name="Ask for control").click()
    expect(here).to_contain_text("Your other window", timeout=SOON_MS)
    expect(here).to_have_attribute("data-held", "true")
    second.get_by_role("button", name="Take over").click(timeout=SOON_MS)
    taking = second.get_by_role("dialog")
    expect(taking.get_by_label("Reason")).to_be_focused()
    second.screenshot(path=shots / "people-takeover.png")
    taking.get_by_label("Reason").fill("the other window is in the hall")
    taking.get_by_role("button", name="Take over").click()
    expect(there).to_have_attribute("data-held", "true", timeout=SOON_MS)
    expect(here).to_have_attribute("data-held", "false", timeout=SOON_MS)
    menu(second, "Sign out")
    for page in (first, second):
        expect(page.get_by_label("Name")).to_be_visible(timeout=SOON_MS)
    with api_of(server, "vic") as vic:
        assert vic.get(f"/rigs/{RIG}/session").json()["lease"]["holder"] is None


def test_an_admin_adds_people_and_shuts_them_out(pages: Pages, shots: Path) -> None:
    admin = signed_in(pages, "ada", "/operate")
    admin.get_by_role("navigation", name="Pages").get_by_role("link", name="People").click()
    form = admin.get_by_role("form", name="New person")
    form.get_by_label("Name").fill("max")
    form.get_by_label("Password").fill("short")
    form.get_by_role("button", name="Add").click()
    expect(form.get_by_role("alert")).to_contain_text("expected 12 to 256", timeout=SOON_MS)
    form.get_by_label("Password").fill(PASSWORD)
    form.get_by_role("button", name="Add").click()
    row = admin.locator("[data-person=max]")
    expect(row).to_be_visible(timeout=SOON_MS)
    seen(admin, shots, "people")
    admin.get_by_label("Role of ada").select_option("viewer")
    expect(admin.get_by_role("main").get_by_role("alert")).to_contain_text("the last admin", timeout=SOON_MS)
    expect(admin.get_by_label("Role of ada")).to_have_value("admin")

    max_ = signed_in(pages, "max", "/plans")
    row.get_by_role("button", name="Disable").click()
    admin.get_by_role("dialog").get_by_role("button", name="Disable").click()
    expect(max_.get_by_role("status")).to_contain_text(OUT, timeout=SOON_MS)
    assert max_.url.endswith("/plans")
    asked: list[str] = []
    max_.on("request", lambda sent: asked.append(sent.url))
    max_.on("websocket", lambda socket: asked.append(socket.url))
    expect(row).to_contain_text("disabled", timeout=SOON_MS)
    seen(max_, shots, "signed-out")
    max_.wait_for_timeout(1500)
    # Nobody knocks at a door that is shut: who is there is all that is asked, and not again and again.
    assert {url.split("/api/v1")[1] for url in asked} <= {"/me"}
    assert len(asked) <= 3
    admin.get_by_role("navigation", name="Pages").get_by_role("link", name="Alarms").click()
    admin.get_by_role("group", name="Shown").get_by_role("button", name="Commands").click()
    expect(admin.get_by_role("table", name="Commands")).to_contain_text("max: disabled True", timeout=SOON_MS)
    seen(admin, shots, "audit")
    admin.set_viewport_size(PHONE)
    admin.get_by_role("navigation", name="Pages").get_by_role("link", name="People").click()
    expect(row).to_be_visible(timeout=SOON_MS)
    seen(admin, shots, "people-phone")
    estop_in_sight(admin)


def test_tokens_and_a_password_of_ones_own(pages: Pages, server: Server, shots: Path) -> None:
    page, elsewhere = signed_in(pages, "eve", "/runs"), signed_in(pages, "eve", "/runs")
    menu(page, "Account")
    page.get_by_label("What it is for").fill("nightly campaign")
    page.get_by_role("button", name="Make").click()
    secret = page.get_by_label("Secret of the token").input_value(timeout=SOON_MS)
    seen(page, shots, "account")
    shown = {"Authorization": f"Bearer {secret}"}
    with httpx.Client(base_url=f"{server.url}/api/v1", headers=shown, timeout=120.0) as program:
        assert program.get("/rigs").status_code == 200
        page.get_by_role("button", name="Revoke nightly campaign").click()
        page.get_by_role("dialog").get_by_role("button", name="Revoke").click()
        expect(page.get_by_role("region", name="Tokens")).to_contain_text("No tokens", timeout=SOON_MS)
        assert program.get("/rigs").status_code == 401

    page.get_by_label("Current password").fill(PASSWORD)
    page.get_by_label("New password", exact=True).fill("another sentence of eve's own")
    page.get_by_label("New password, again").fill("another sentence of eve's own")
    page.get_by_role("button", name="Change the password").click()
    expect(page.get_by_text("Changed.")).to_be_visible(timeout=SOON_MS)
    expect(elsewhere.get_by_role("status")).to_contain_text(OUT, timeout=SOON_MS)
    page.set_viewport_size(PHONE)
    seen(page, shots, "account-phone")
    person_of(page).click()
    page.screenshot(path=shots / "people-menu-phone.png")
    estop_in_sight(page)
    page.get_by_role("button", name="Sign out").click()
    expect(page.get_by_label("Name")).to_be_visible(timeout=SOON_MS)
    expect(page.get_by_role("status")).to_have_count(0)
