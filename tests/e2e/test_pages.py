"""Every page, in both themes and on a tablet: it is there, it can be read, and nothing sticks out."""

import re
from pathlib import Path
from typing import Literal, get_args

import pytest
from playwright.sync_api import Page, Route, ViewportSize, expect

from tests.e2e.conftest import TABLET, Pages, Stock
from tests.e2e.console import SLOW_MS, SOON_MS

pytestmark = pytest.mark.browser

Theme = Literal["dark", "light"]
PAGES = {
    "operate": "Operate",
    "trajectories": "Flights",
    "plans": "Plans",
    "compare": "Compare",
    "runs": "Runs",
    "alarms": "Alarms",
    "rigs": "Rigs",
}

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
    const ink = parse(style.color);
    for (let e = element; e; e = e.parentElement) ink[3] *= Number(getComputedStyle(e).opacity);
    const [a, b] = [light(over(ink, back)), light(back)];
    const ratio = (Math.max(a, b) + 0.05) / (Math.min(a, b) + 0.05);
    const size = parseFloat(style.fontSize);
    const large = size >= 24 || (size >= 18.66 && Number(style.fontWeight) >= 700);
    const text = element.textContent.trim().slice(0, 40);
    if (ratio < (large ? 3 : 4.5)) found.push(`${ratio.toFixed(2)} ${element.className} "${text}"`);
  }
  return found;
}"""


# Tables that are wider than their place: what sticks out is out of sight.
CUT_TABLES = """() => [...document.querySelectorAll(".scroll-x")]
  .filter((e) => e.scrollWidth > e.clientWidth)
  .map((e) => `${e.scrollWidth} > ${e.clientWidth}: ${e.textContent.trim().slice(0, 40)}`)"""


def visit(page: Page, name: str) -> None:
    """Go to a page by its link, and wait until it has drawn what it shows."""
    page.get_by_role("navigation", name="Pages").get_by_role("link", name=PAGES[name]).click()
    if name == "operate":
        expect(page.get_by_role("toolbar", name="Commands")).to_be_visible()
    else:
        expect(page.get_by_role("heading", name=PAGES[name], exact=True)).to_be_visible()
    if name in ("operate", "trajectories", "plans"):
        expect(page.locator(".uplot canvas").first).to_be_visible(timeout=SOON_MS)
    if name == "compare":
        expect(page.locator("[data-method=exact]")).to_be_visible(timeout=SOON_MS)
    if name == "runs":
        expect(page.get_by_text("Reading the records")).to_be_hidden(timeout=SOON_MS)


def with_the_longest_run(route: Route) -> None:
    """The server's list of runs, and in front of it the one whose row is the longest."""
    answer = route.fetch()
    listed = answer.json()
    longest = {"rig": "horizontal-4-in-the-hall", "who": "the operator of the early shift", "bytes": 123_456_789}
    ended = {"end": "fault", "end_code": "tracking_error_beyond_limit", "incident": "live_source_lost"}
    figures = {"samples": 3_600_000, "lost_samples": 12_345, "duration_s": 3600.0, "max_tracking_error_deg": 359.1234}
    kept = {"started_at": "2026-11-29T23:59:59.999Z", "complete": False, "error": None, "max_solve_error_deg": 1.8e-14}
    labels = {"tags": ["acceptance-of-november"], "notes": ""}
    first = {"id": "the-longest", "pinned": True, **longest, **ended, **figures, **kept, **labels}
    route.fulfill(response=answer, json=[first, *listed])


def opened(pages: Pages, viewport: ViewportSize | None = None) -> Page:
    """The console, with a stocked server behind it."""
    page = pages.open(viewport=viewport, touch=True) if viewport else pages.open()
    page.route(re.compile(r"/api/v1/runs(\?.*)?$"), with_the_longest_run)
    page.goto("/operate/horizontal-4")
    expect(page.get_by_test_id("state")).to_have_attribute("data-state", re.compile(r"\w+"), timeout=SOON_MS)
    return page


def test_text_can_be_read_in_both_themes(pages: Pages, stocked: Stock, shots: Path) -> None:
    page = opened(pages)
    low = {}
    for name in PAGES:
        visit(page, name)
        for theme in get_args(Theme):
            page.emulate_media(color_scheme=theme)
            expect(page.locator("html")).to_have_attribute("data-theme", theme)
            # A colour on its way from one theme to the other is neither's.
            page.evaluate("Promise.all(document.getAnimations().map((each) => each.finished.catch(() => null)))")
            low[name, theme] = page.evaluate(LOW_CONTRAST)
            page.screenshot(path=shots / f"{name}-{theme}.png")
        assert page.evaluate(CUT_TABLES) == [], name
    assert {where: found for where, found in low.items() if found} == {}


def test_tablet_holds_every_page(pages: Pages, stocked: Stock, shots: Path) -> None:
    page = opened(pages, TABLET)
    page.emulate_media(color_scheme="light")
    for name in PAGES:
        visit(page, name)
        page.screenshot(path=shots / f"{name}-tablet.png")
        assert page.evaluate("document.documentElement.scrollWidth") <= TABLET["width"], name
        assert page.evaluate(CUT_TABLES) == [], name
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


def test_a_reload_keeps_theme_and_address(page: Page, stocked: Stock) -> None:
    page.goto(f"/plans/{stocked.plan['id']}")
    shown = page.get_by_role("region", name="Plan of Slow roll", exact=True)
    expect(shown).to_be_visible(timeout=SOON_MS)
    page.get_by_role("button", name="Use the light theme").click()
    page.reload()
    expect(shown).to_be_visible(timeout=SOON_MS)
    assert page.locator("html").get_attribute("data-theme") == "light"
    # A rig's name may have a dot in it.
    answer = page.goto("/operate/my.rig")
    assert answer is not None
    assert answer.ok
    expect(page.get_by_text("no rig named my.rig")).to_be_visible(timeout=SOON_MS)


def test_the_api_is_shown_without_a_network(page: Page, shots: Path) -> None:
    page.goto("/api/docs")
    expect(page.get_by_role("heading", name="Fullpose", exact=False).first).to_be_visible(timeout=SLOW_MS)
    expect(page.get_by_text("/api/v1/version")).to_be_visible(timeout=SLOW_MS)
    page.screenshot(path=shots / "api.png")
