"""The comparison's page in a real Chromium: it draws without a network, and methods can be taken out."""

import shutil
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import pytest
from playwright.sync_api import Page, sync_playwright

from fullpose.rig import builtin_rigs
from fullpose.scenarios import SCENARIOS
from fullpose_server.planning.flown_within import flown_within
from fullpose_server.planning.make_comparison import make_comparison

pytestmark = [pytest.mark.browser, pytest.mark.slow]
METHODS = ["exact", "lagrange", "three_axis"]


@pytest.fixture(scope="module")
def page(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Page]:
    scenario = replace(SCENARIOS["both_beyond_90"], duration=4.0)
    made = make_comparison(
        "flight", flown_within(scenario.time, scenario.quaternion, None), builtin_rigs()["vertical-4"], METHODS
    )
    file: Path = tmp_path_factory.mktemp("page") / "p.html"
    file.write_text(made.page, encoding="utf-8")
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=shutil.which("chromium"), args=["--no-sandbox"])
        opened = browser.new_page(viewport={"width": 1200, "height": 900})
        wrong: list[str] = []
        opened.on("pageerror", lambda error: wrong.append(str(error)))
        opened.on("request", lambda request: wrong.append(request.url) if request.url != file.as_uri() else None)
        opened.goto(file.as_uri())
        yield opened
        assert not wrong
        browser.close()


def curves(page: Page, colour: str) -> int:
    return page.locator(f'figure path[stroke="{colour}"]').count()


def test_every_frame_has_a_curve_a_method(page: Page) -> None:
    assert page.locator("figure").count() == 3
    assert page.locator("tbody tr").count() == 3
    for colour in ("#0072b2", "#d55e00", "#009e73"):
        assert curves(page, colour) == 1 + 3 * 4  # the error, and three plots a frame
    # The rate and acceleration limits of three_axis's frames are passed: the bands are in sight.
    assert page.locator('figure rect[fill="#fbe9e7"]').count() > 0
    assert page.locator('figure rect[fill="#e5554a"]').count() > 0


def test_a_method_can_be_taken_out_and_shown_alone(page: Page) -> None:
    button = page.locator("#chips button", has_text="three_axis")
    before = page.locator("figure").nth(2).inner_html()
    button.click()
    assert button.get_attribute("aria-pressed") == "false"
    assert curves(page, "#009e73") == 0
    assert page.locator("figure").nth(2).inner_html() != before
    page.locator("#chips button", has_text="lagrange").dblclick()
    assert curves(page, "#d55e00") == 13
    assert curves(page, "#0072b2") == 0
    page.locator("#chips .all").click()
    assert page.locator('#chips button[aria-pressed="true"]').count() == 3


def test_a_point_can_be_read(page: Page) -> None:
    page.locator("figure svg.plot").nth(1).hover()
    tip = page.locator("#tip").inner_text()
    assert "t = 1.9" in tip or "t = 2.0" in tip
    assert all(method in tip for method in METHODS)
