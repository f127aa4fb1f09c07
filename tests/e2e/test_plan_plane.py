"""The plane of time and base angle on a plan's page."""

import re
from pathlib import Path

import pytest
from playwright.sync_api import Page, ViewportSize, expect

from tests.e2e.conftest import Pages, Stock
from tests.e2e.console import SOON_MS

PHONE: ViewportSize = {"width": 390, "height": 844}


def test_the_plane_says_why_a_plan_is_tight_at_a_glance(page: Page, stocked: Stock, shots: Path) -> None:
    page.goto(f"/plans/{stocked.plan['id']}")
    panel = page.get_by_role("region", name="Plane of time and base angle")
    panel.scroll_into_view_if_needed(timeout=SOON_MS)
    sentence = panel.get_by_text(re.compile(r"^Tightest at \d+\.\d{3} s: the \w+ frame's \w+ limit, .+\.$"))
    expect(sentence).to_be_visible(timeout=SOON_MS)

    # There at once, and told; a hover tells any other point, and the cursor is that of the plots above.
    panel.get_by_role("button", name="Show where").click()
    at = float((sentence.text_content() or "").split()[2])
    assert float(page.get_by_label("Time", exact=True).input_value()) == pytest.approx(at, abs=0.01)
    reading = panel.get_by_test_id("plane-reading")
    expect(reading).to_contain_text(f"At {at:.3f} s")
    plot = panel.get_by_role("img", name=re.compile("^Plane of time"))
    plot.hover(position={"x": 300, "y": 60})
    expect(reading).not_to_contain_text(f"At {at:.3f} s")
    expect(page.get_by_text(re.compile(r"^deg at \d+\.\d{3} s$"))).to_have_text(
        "deg at " + (reading.text_content() or "").split()[1] + " s"
    )
    page.screenshot(path=shots / "plane-dark.png")

    # By keyboard: the slider of base angles, that says what it reads.
    page.mouse.move(0, 0)
    slider = panel.get_by_label("Base angle looked at")
    slider.focus()
    before = reading.text_content() or ""
    page.keyboard.press("PageUp")
    expect(reading).not_to_have_text(before)
    assert slider.get_attribute("aria-valuetext") == reading.text_content()


def test_the_plane_fits_a_phone(pages: Pages, stocked: Stock, shots: Path) -> None:
    page = pages.open(viewport=PHONE)
    page.emulate_media(color_scheme="light")
    page.goto(f"/plans/{stocked.plan['id']}")
    panel = page.get_by_role("region", name="Plane of time and base angle")
    panel.scroll_into_view_if_needed(timeout=SOON_MS)
    expect(panel.get_by_test_id("plane-reading")).to_contain_text("base at", timeout=SOON_MS)
    assert page.evaluate("document.documentElement.scrollWidth") <= PHONE["width"]
    panel.screenshot(path=shots / "plane-phone-light.png")
