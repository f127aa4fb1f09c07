"""The alarms page on a real server: what stands is acknowledged there, what is shelved comes back, on a phone too."""

import asyncio
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import get_args

import pytest
from playwright.sync_api import Page, ViewportSize, expect

from fullpose_server.client import Client
from tests.e2e.conftest import TROUBLED, Pages, Server
from tests.e2e.console import SOON_MS, Console
from tests.e2e.test_pages import CUT_TABLES, LOW_CONTRAST, Theme

pytestmark = pytest.mark.browser

RIG = TROUBLED
PHONE: ViewportSize = {"width": 390, "height": 844}


async def troubled(url: str) -> None:
    """An operator before us: a warning put on a shelf, then an E-stop."""
    async with Client(url, "earlier") as earlier:
        await earlier.take_lease(RIG, "takeover")
        if (await earlier.session(RIG))["state"] == "disconnected":
            await earlier.command(RIG, "connect")
        await earlier.command(RIG, "shelve", code="lateness", minutes=60.0, reason="a busy machine")
        await earlier.estop(RIG)
        await earlier.release_lease(RIG)


def tab(page: Page, name: str) -> None:
    page.get_by_role("group", name="Shown").get_by_role("button", name=name).click()


def pictured(page: Page, shots: Path, name: str) -> None:
    """In both themes: seen, and legible."""
    for theme in get_args(Theme):
        page.emulate_media(color_scheme=theme)
        expect(page.locator("html")).to_have_attribute("data-theme", theme)
        page.evaluate("Promise.all(document.getAnimations().map((each) => each.finished.catch(() => null)))")
        assert page.evaluate(LOW_CONTRAST) == [], (name, theme)
        page.screenshot(path=shots / f"alarms-{name}-{theme}.png")


def test_alarms_are_seen_and_acknowledged_and_shelves_taken_away(pages: Pages, server: Server, shots: Path) -> None:
    with ThreadPoolExecutor(1) as other:  # this thread's loop is the browser's
        other.submit(asyncio.run, troubled(server.url)).result()
    page = pages.open()
    console = Console(page, RIG)
    console.open()
    console.take_control()
    page.get_by_role("link", name="Alarms").click()
    page.get_by_label("Code").fill("estop")
    newest = page.get_by_role("list", name="Alarm history").locator("[data-code=estop]").first
    expect(newest).to_contain_text("waits for acknowledge", timeout=SOON_MS)
    page.get_by_label("Code").fill("")
    pictured(page, shots, "history")
    newest.get_by_role("button", name="Acknowledge").click()
    expect(newest).to_contain_text("acknowledged by", timeout=SOON_MS)

    tab(page, "Shelves")
    shelf = page.get_by_role("list", name=f"Shelves of {RIG}").get_by_role("listitem")
    expect(shelf).to_contain_text("a busy machine")
    expect(shelf).to_contain_text("min left")
    pictured(page, shots, "shelves")
    shelf.get_by_role("button", name="Unshelve").click()
    expect(page.get_by_text("Nothing is on a shelf")).to_be_visible(timeout=SOON_MS)

    tab(page, "Server")
    expect(page.get_by_role("list", name="Warnings of the server")).to_contain_text("no users are configured")
    pictured(page, shots, "server")
    tab(page, "Commands")
    expect(page.get_by_role("table", name="Commands")).to_contain_text("unshelve", timeout=SOON_MS)
    pictured(page, shots, "commands")

    page.set_viewport_size(PHONE)
    for name in ("Commands", "Server", "Shelves", "Alarms"):
        tab(page, name)
        page.screenshot(path=shots / f"alarms-{name.lower()}-phone.png")
        assert page.evaluate("document.documentElement.scrollWidth") <= PHONE["width"], name
        assert page.evaluate(CUT_TABLES) == [], name
    box = page.get_by_role("button", name="E-stop").bounding_box()
    assert box is not None
    assert box["x"] + box["width"] <= PHONE["width"]
