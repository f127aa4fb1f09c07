"""Every page, in both themes and on a tablet: it is there, it can be read, and nothing sticks out."""

import re
from pathlib import Path
from typing import Literal

import pytest
from playwright.sync_api import Browser, Page, ViewportSize, expect

from tests.e2e.conftest import FLIGHT, Server
from tests.e2e.console import Console

pytestmark = pytest.mark.browser

Theme = Literal["dark", "light"]
DESK: ViewportSize = {"width": 1440, "height": 900}
TABLET: ViewportSize = {"width": 1024, "height": 768}
PAGES = {"operate": "Operate", "trajectories": "Flights", "plans": "Plans", "runs": "Runs", "rigs": "Rigs"}

# Every visible text against what lies behind it, by WCAG 2's formula; 4.5:1, or 3:1 for large text.
LOW_CONTRAST = """() => {
  const parse = (text) => {
    const n = text.match(/[\\d.]+/g).map(Number);
    const unit = text.startsWith("color(") ? 255 : 1;
    return [n[0] * unit, n[1] * unit, n[2] * unit, n[3] ?? 1];
  };
  const over = (top, under) => [0, 1, 2].map((i) => top[i] * top[3] + under[i] * (1 - top[3])).concat(1);
  const light = (c) => {
    const [r, g, b] = c.slice(0, 3).map((v) => (v /= 255) <= 0.03928 ? v / 12.92 : ((v + 0.055) / 1.055) ** 2.4);
    return 0.2126 * r + 0.7152 * g + 0.0722 * b;
  };
  const behind = (element) => {
    const layers = [];
    for (let e = element; e; e = e.parentElement) layers.push(parse(getComputedStyle(e).backgroundColor));
    return layers.reverse().reduce((under, top) => over(top, under), [255, 255, 255, 1]);
  };
  const found = [];
  for (const element of document.querySelectorAll("body *")) {
    const own = [...element.childNodes].some((n) => n.nodeType === 3 && n.textContent.trim() !== "");
    const style = getComputedStyle(element);
    if (!own || element.closest(":disabled, [role=img], option, svg")) continue;
    if (!element.checkVisibility({ visibilityProperty: true })) continue;
    const back = behind(element);
    const [a, b] = [light(over(parse(style.color), back)), light(back)];
    const ratio = (Math.max(a, b) + 0.05) / (Math.min(a, b) + 0.05);
    const size = parseFloat(style.fontSize);
    const large = size >= 24 || (size >= 18.66 && Number(style.fontWeight) >= 700);
    const text = element.textContent.trim().slice(0, 40);
    if (ratio < (large ? 3 : 4.5)) found.push(`${ratio.toFixed(2)} ${element.className} "${text}"`);
  }
  return found;
}"""


@pytest.fixture(scope="module")
def planned(browser: Browser, server: Server) -> str:
    """A server with a flight and a plan in it; the rig's name."""
    with browser.new_context(base_url=server.url) as context:
        console = Console(context.new_page(), "horizontal-4")
        console.open()
        console.upload(FLIGHT, "ned")
        console.solve("exact")
    return console.rig


def visit(page: Page, name: str, rig: str) -> None:
    """Open a page by its link, and wait until it has drawn."""
    page.goto(f"/operate/{rig}")
    page.get_by_role("navigation").get_by_role("link", name=PAGES[name]).click()
    if name == "operate":
        expect(page.get_by_role("toolbar", name="Commands")).to_be_visible()
    else:
        expect(page.get_by_role("heading", name=PAGES[name], exact=True)).to_be_visible()
    page.wait_for_timeout(700)


@pytest.mark.parametrize("theme", ["dark", "light"])
@pytest.mark.parametrize("name", PAGES)
def test_text_can_be_read(browser: Browser, server: Server, planned: str, name: str, theme: Theme, shots: Path) -> None:
    with browser.new_context(
        base_url=server.url,
        viewport={"width": 1440, "height": 900},
        color_scheme="dark" if theme == "dark" else "light",
    ) as context:
        page = context.new_page()
        visit(page, name, planned)
        assert page.locator("html").get_attribute("data-theme") == theme
        page.screenshot(path=shots / f"{name}-{theme}.png")
        assert page.evaluate(LOW_CONTRAST) == []


@pytest.mark.parametrize("name", PAGES)
def test_tablet_holds_every_page(browser: Browser, server: Server, planned: str, name: str, shots: Path) -> None:
    with browser.new_context(base_url=server.url, viewport=TABLET, has_touch=True, color_scheme="light") as context:
        page = context.new_page()
        visit(page, name, planned)
        page.screenshot(path=shots / f"{name}-tablet.png")
        assert page.evaluate("document.documentElement.scrollWidth") <= TABLET["width"]
        for label in (re.compile("^Stop"), re.compile("^E-stop")):
            box = page.get_by_role("button", name=label).bounding_box()
            assert box is not None
            assert box["x"] + box["width"] <= TABLET["width"]
            assert box["y"] + box["height"] <= TABLET["height"]
            assert box["height"] >= 40
        if name == "operate":
            for button in page.get_by_role("toolbar").get_by_role("button").all():
                inside = button.bounding_box()
                assert inside is not None
                assert inside["x"] + inside["width"] <= TABLET["width"]


def test_theme_is_remembered(page: Page) -> None:
    page.goto("/rigs")
    page.get_by_role("button", name="Use the light theme").click()
    page.reload()
    assert page.locator("html").get_attribute("data-theme") == "light"


def test_addresses_survive_a_reload(page: Page, planned: str) -> None:
    plan = page.request.get("/api/v1/plans").json()[0]
    page.goto(f"/plans/{plan['id']}")
    expect(page.get_by_role("region", name=f"Plan of {plan['trajectory_name']}")).to_be_visible()
    page.reload()
    expect(page.get_by_role("region", name=f"Plan of {plan['trajectory_name']}")).to_be_visible()
    page.go_back()
