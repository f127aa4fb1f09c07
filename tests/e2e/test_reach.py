"""Stop and E-stop are in reach on every page at every width, and a finger finds what it presses."""

import re
from pathlib import Path

import pytest
from playwright.sync_api import Page, ViewportSize, expect

from tests.e2e.conftest import Pages, Stock
from tests.e2e.test_pages import PAGES, opened, visit

pytestmark = pytest.mark.browser

SCREENS: tuple[ViewportSize, ...] = (
    {"width": 360, "height": 740},
    {"width": 390, "height": 844},
    {"width": 768, "height": 1024},
    {"width": 820, "height": 1180},
    {"width": 1024, "height": 768},
)
FINGER_PX = 44

# What of a button, read from its box: where it is cut, small, or covered by something else at any of nine points.
OUT_OF_REACH = """([selector, least]) => [...document.querySelectorAll(selector)].flatMap((button) => {
  const box = button.getBoundingClientRect();
  const name = button.textContent.trim();
  const found = [];
  if (box.left < 0 || box.top < 0 || box.right > innerWidth || box.bottom > innerHeight) found.push(`${name} is cut`);
  if (box.width < least || box.height < least) found.push(`${name} is ${box.width} x ${box.height}`);
  for (const x of [0.1, 0.5, 0.9]) for (const y of [0.1, 0.5, 0.9]) {
    const top = document.elementFromPoint(box.left + x * box.width, box.top + y * box.height);
    if (!button.contains(top)) found.push(`${name} is under ${top?.tagName}.${top?.className}`);
  }
  return found;
})"""

# What can be pressed, is seen, and is smaller than a finger needs; links within a text are the text's.
SMALL_TARGETS = """(least) => [...document.querySelectorAll(
    "button, select, summary, a.button, nav a, input:not([type=checkbox], [type=radio], [type=file])"
  )].flatMap((each) => {
    const box = each.getBoundingClientRect();
    if (box.width === 0 || !each.checkVisibility({ visibilityProperty: true })) return [];
    if (box.width >= least - 0.5 && box.height >= least - 0.5) return [];
    return [`${each.tagName}.${each.className} "${each.textContent.trim().slice(0, 30)}" ${box.width}x${box.height}`];
  })"""

# Texts that lie over each other: the boxes of their lines, seen and not of one another's element. What a dialog covers
# in part is no overprint.
OVERPRINTS = """() => {
  const LAYER = "dialog, [role=dialog]";
  const seen = [];
  const walker = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
  for (let node = walker.nextNode(); node; node = walker.nextNode()) {
    const owner = node.parentElement;
    if (node.textContent.trim() === "" || owner.closest("svg, option, .reader, .u-legend, script, style")) continue;
    if (!owner.checkVisibility({ visibilityProperty: true, opacityProperty: true })) continue;
    const range = document.createRange();
    range.selectNodeContents(node);
    for (const box of range.getClientRects()) {
      let { left, right, top, bottom } = box;
      for (let e = owner; e; e = e.parentElement) {
        if (getComputedStyle(e).overflow === "visible") continue;
        const cut = e.getBoundingClientRect();
        [left, right] = [Math.max(left, cut.left), Math.min(right, cut.right)];
        [top, bottom] = [Math.max(top, cut.top), Math.min(bottom, cut.bottom)];
      }
      const at = document.elementFromPoint((left + right) / 2, (top + bottom) / 2);
      if (right - left < 3 || bottom - top < 3 || !at || !(at.contains(owner) || owner.contains(at))) continue;
      seen.push({ owner, text: node.textContent.trim().slice(0, 30), left, right, top, bottom });
    }
  }
  const found = [];
  for (let i = 0; i < seen.length; i++) for (let j = i + 1; j < seen.length; j++) {
    const [a, b] = [seen[i], seen[j]];
    if (a.owner === b.owner || a.owner.closest(LAYER) !== b.owner.closest(LAYER)) continue;
    const wide = Math.min(a.right, b.right) - Math.max(a.left, b.left);
    const high = Math.min(a.bottom, b.bottom) - Math.max(a.top, b.top);
    if (wide > 2 && high > 4) found.push(`"${a.text}" over "${b.text}"`);
  }
  return found;
}"""


# Draws the longest of what scrolls on the page up by its height; whether there was more.
SCROLL_ON = """() => {
  const scrollers = [...document.querySelectorAll("main, main *")].filter(
    (e) => e.scrollHeight > e.clientHeight + 4 && ["auto", "scroll"].includes(getComputedStyle(e).overflowY)
  );
  const longest = scrollers.sort((a, b) => b.clientHeight * b.clientWidth - a.clientHeight * a.clientWidth)[0];
  if (!longest || longest.scrollTop + longest.clientHeight >= longest.scrollHeight - 4) return false;
  longest.scrollTop += longest.clientHeight;
  return true;
}"""


def check(page: Page, where: str) -> None:
    """Hold all of it on the page as it is now."""
    assert page.evaluate(OUT_OF_REACH, [".stops button", FINGER_PX]) == [], where
    assert page.locator(".stops button").count() == 2, where
    wide = page.evaluate("[document.documentElement.scrollWidth, document.body.scrollWidth, innerWidth]")
    assert max(wide[:2]) <= wide[2], where
    over = page.evaluate(OVERPRINTS)
    while page.evaluate(SCROLL_ON):
        over += page.evaluate(OVERPRINTS)
    assert over == [], where


@pytest.mark.parametrize("screen", SCREENS, ids=lambda screen: str(screen["width"]))
def test_stops_are_in_reach_on_every_page(pages: Pages, stocked: Stock, shots: Path, screen: ViewportSize) -> None:
    page = opened(pages, screen)
    for name in PAGES:
        visit(page, name)
        page.screenshot(path=shots / f"{name}-{screen['width']}.png")
        check(page, f"{name} at {screen['width']}")
        assert page.evaluate(SMALL_TARGETS, FINGER_PX) == [], f"{name} at {screen['width']}"
    # Nothing that opens covers them: a question, the palette, the keys.
    page.get_by_role("navigation", name="Pages").get_by_role("link", name="Flights").click()
    page.get_by_role("button", name="Delete the flight").click()
    expect(page.get_by_role("dialog")).to_be_visible()
    check(page, f"a question at {screen['width']}")
    page.get_by_role("dialog").get_by_role("button", name="Cancel").click()
    page.get_by_role("button", name="Pages and commands").click()
    expect(page.get_by_role("combobox", name=re.compile("^Search"))).to_be_focused()
    page.screenshot(path=shots / f"palette-{screen['width']}.png")
    assert page.evaluate(OUT_OF_REACH, [".stops button", FINGER_PX]) == []


def test_no_text_lies_over_another_on_a_desk(pages: Pages, stocked: Stock) -> None:
    page = opened(pages, {"width": 1440, "height": 900})
    for name in PAGES:
        visit(page, name)
        check(page, name)
