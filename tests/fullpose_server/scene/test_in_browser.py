"""The scene in a real Chromium, through the proxy: it draws, it moves, and it carries nothing of viser's own."""

import io
import shutil
import time
from collections.abc import Iterator

import numpy as np
import pytest
from PIL import Image
from playwright.sync_api import Browser, Page, sync_playwright

from fullpose_server.scene import palette
from tests.fullpose_server.scene.browser_side import sample
from tests.fullpose_server.scene.conftest import Served

pytestmark = [pytest.mark.browser, pytest.mark.slow]
ARGUMENTS = [
    "--use-angle=swiftshader",
    "--enable-unsafe-swiftshader",
    "--no-sandbox",
    "--disable-background-networking",
]
PATIENCE_S = 60.0

PATIENT_MS = 120_000  # software rendering on a machine that does much else


@pytest.fixture(scope="module")
def browser() -> Iterator[Browser]:
    with sync_playwright() as playwright:
        chromium = playwright.chromium.launch(executable_path=shutil.which("chromium"), args=ARGUMENTS)
        yield chromium
        chromium.close()


def picture(page: Page) -> np.ndarray:
    """The page as it looks. (height, width, 3)"""
    return np.asarray(Image.open(io.BytesIO(page.screenshot(timeout=PATIENT_MS))).convert("RGB"), dtype=np.int16)


def share_of(image: np.ndarray, colour: str) -> float:
    """The share of pixels with the colour's hue, lit or in shade."""
    r, g, b = palette.rgb(colour)
    hue = np.array([r, g, b], float) - np.mean([r, g, b])
    off = image - image.mean(axis=-1, keepdims=True)
    length = np.linalg.norm(off, axis=-1)
    cosine = off @ hue / np.maximum(length * np.linalg.norm(hue), 1e-9)
    return float(np.mean((cosine > 0.97) & (length > 25.0)))


def steady(page: Page) -> np.ndarray:
    """The picture once it has stopped changing."""
    end = time.monotonic() + PATIENCE_S
    before = picture(page)
    while time.monotonic() < end:
        page.wait_for_timeout(500)
        now = picture(page)
        if share_of(now, palette.FRAME_COLOURS["outer"]) > 0.005 and np.abs(now - before).mean() < 0.05:
            return now
        before = now
    raise AssertionError(f"the picture did not settle in {PATIENCE_S} s")


def test_scene_draws_the_rig_and_moves_with_it(browser: Browser, served: Served) -> None:
    served.scenes.update("vertical-4", sample([0.0] * 4))
    page = browser.new_page(viewport={"width": 640, "height": 480})
    page.goto(f"http://{served.address}/scene/vertical-4/")
    first = steady(page)
    for frame, colour in palette.FRAME_COLOURS.items():
        assert share_of(first, colour) > 0.002, f"{frame} is not to be seen"
    assert first[5:40, 5:40].mean() > 230, "a light background"
    assert page.locator(".mantine-Paper-root:visible").count() == 0, "viser's panel is gone"

    served.scenes.update("vertical-4", sample([40.0, 50.0, -30.0, 60.0]))
    page.wait_for_timeout(1000)
    moved = steady(page)
    assert np.mean(np.abs(moved - first).max(axis=-1) > 40) > 0.02, "the rig moved, the picture did not"
    page.close()


def test_dark_and_narrow(browser: Browser, served: Served) -> None:
    page = browser.new_page(viewport={"width": 360, "height": 420})
    page.goto(f"http://{served.address}/scene/vertical-4/?darkMode")
    image = steady(page)
    assert image[5:40, 5:40].mean() < 60, "a dark background"
    assert page.locator(".mantine-Paper-root:visible").count() == 0, "viser's bottom sheet is gone"
    page.close()
