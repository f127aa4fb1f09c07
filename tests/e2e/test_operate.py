"""An operator flies a real flight on the simulated rig, in a real browser."""

import os
import re
import signal
from collections.abc import Sequence
from pathlib import Path

import pytest
from playwright.sync_api import Browser, Page, expect

from tests.e2e.conftest import FLIGHT, Server
from tests.e2e.console import FRAMES, Console
from tests.e2e.picture import changed, colours, dominance

pytestmark = pytest.mark.browser


def apart(one: Sequence[float], other: Sequence[float]) -> float:
    """How far the frame that is farthest is from where it was [deg]."""
    return max(abs(a - b) for a, b in zip(one, other, strict=True))


def test_flight_from_upload_to_reset(page: Page, shots: Path) -> None:
    console = Console(page, "vertical-4")
    console.open()
    console.expect_state("disconnected")
    page.screenshot(path=shots / "operate-first.png")
    console.fly(FLIGHT)

    # It flies: frames turn, and the solved angles reproduce the flight.
    before = console.angles()
    solve, tracking = [], []
    for _ in range(20):
        page.wait_for_timeout(100)
        solve.append(console.error("solve"))
        tracking.append(console.error("tracking"))
    turned = apart(before, console.angles())
    assert turned > 1.0
    assert max(solve) < 1e-9
    assert 0.0 < max(tracking) < 5.0
    page.screenshot(path=shots / "operate-running-dark.png")

    # Space holds on the path, Space resumes.
    page.keyboard.press("Space")
    console.expect_state("held")
    page.wait_for_timeout(1500)
    time, angles = console.path_time(), console.angles()
    page.wait_for_timeout(700)
    assert console.path_time() == time
    assert apart(angles, console.angles()) < 0.05
    assert console.error("solve") < 1e-9
    page.keyboard.press("Space")
    console.expect_state("running")
    console.until(lambda: console.path_time() > time + 0.5, 10.0)
    assert console.error("solve") < 1e-9

    # E-stop latches; the way out is to acknowledge, then to reset.
    page.get_by_role("button", name="E-stop").click()
    console.expect_state("estopped")
    expect(console.button("reset")).to_be_hidden()
    expect(page.get_by_text("waits for acknowledge").first).to_be_visible()
    page.screenshot(path=shots / "operate-estopped.png")
    console.button("acknowledge").click()
    expect(console.button("acknowledge")).to_be_hidden()
    page.wait_for_timeout(2000)  # it brakes first
    console.give("reset", "idle")

    # What was flown is on record.
    page.get_by_role("navigation").get_by_role("link", name="Runs").click()
    row = page.get_by_role("row").filter(has_text="vertical-4").first
    expect(row).to_be_visible()
    page.screenshot(path=shots / "runs-flown.png")
    address = row.get_by_role("link", name="CSV").get_attribute("href")
    assert address is not None
    exported = page.request.get(address)
    assert exported.ok
    assert len(exported.text().splitlines()) > 5000  # every tick of more than five seconds at 1 kHz


def test_scene_shows_the_rig_and_moves(page: Page, shots: Path) -> None:
    console = Console(page, "horizontal-4")
    console.open()
    scene = page.locator("iframe")
    # The machine is there before it flies: many colours, none over nearly all of the picture.
    console.until(lambda: colours(scene.screenshot()) > 100, 60.0)
    console.fly(FLIGHT)
    page.wait_for_timeout(1500)
    first = scene.screenshot(path=shots / "scene.png")
    assert dominance(first) < 0.97
    page.wait_for_timeout(2000)
    assert changed(first, scene.screenshot()) > 0.002
    page.get_by_role("button", name=re.compile("^Stop")).click()
    console.expect_state("armed", within_ms=30_000)


def test_who_only_watches_can_stop_but_not_command(page: Page, browser: Browser, server: Server) -> None:
    flown = Console(page, "vertical-limited")
    flown.open()
    with browser.new_context(base_url=server.url) as other:
        other.route("**/scene/**", lambda route: route.abort())  # two scenes are too much for software rendering
        watched = Console(other.new_page(), "vertical-limited")
        watched.open()
        flown.fly(FLIGHT)
        watched.expect_state("running")
        expect(watched.page.get_by_role("button", name="Ask for control")).to_be_visible()
        expect(watched.button("hold")).to_be_disabled()
        watched.page.keyboard.press("Escape")
        flown.expect_state("armed", within_ms=30_000)
        expect(watched.button("start")).to_be_disabled()

    # And by hand: all frames to a pose, and there.
    flown.button("move").click()
    dialog = page.get_by_role("dialog")
    pose = (5.0, -4.0, 3.0, -2.0)
    for name, target in zip(FRAMES, pose, strict=True):
        dialog.get_by_label(name).fill(str(target))
    dialog.get_by_role("button", name="Move").click()
    flown.until(
        lambda: max(abs(a - b) for a, b in zip(flown.angles(), (5.0, -4.0, 3.0, -2.0), strict=True)) < 0.05, 30.0
    )
    flown.expect_state("armed")
    flown.give("disarm", "ready")


def test_control_is_asked_for_and_handed_over(page: Page, browser: Browser, server: Server) -> None:
    holder = Console(page, "horizontal-3")
    holder.open()
    holder.take_control()
    with browser.new_context(base_url=server.url) as other:
        other.route("**/scene/**", lambda route: route.abort())  # two scenes are too much for software rendering
        asker = Console(other.new_page(), "horizontal-3")
        asker.open()
        asker.page.get_by_role("button", name="Ask for control").click()
        expect(page.get_by_text("asks for control")).to_be_visible()
        page.get_by_role("button", name="Hand over").click()
        expect(asker.page.get_by_test_id("lease")).to_have_attribute("data-held", "true")
        expect(page.get_by_test_id("lease")).to_have_attribute("data-held", "false")
        asker.give("connect", "idle")
        # A reload of the page keeps control.
        asker.page.reload()
        expect(asker.page.get_by_test_id("lease")).to_have_attribute("data-held", "true")
        asker.page.get_by_role("button", name="Release").click()
        expect(page.get_by_role("button", name="Take control")).to_be_visible()


def test_stale_data_disables_motion_but_never_stop(page: Page, server: Server) -> None:
    console = Console(page, "vertical-3")
    console.open()
    console.take_control()
    console.give("connect", "idle")
    freshness = page.locator("[data-freshness]")
    expect(freshness).to_have_attribute("data-freshness", "fresh")
    os.kill(server.pid, signal.SIGSTOP)
    try:
        expect(freshness).to_have_attribute("data-freshness", "stale", timeout=4000)
        expect(page.get_by_role("alert").filter(has_text="Motion is disabled")).to_be_visible()
        for name in ("arm", "start", "move", "home"):
            expect(console.button(name)).to_be_disabled()
        expect(page.get_by_role("button", name=re.compile("^Stop"))).to_be_enabled()
        expect(page.get_by_role("button", name="E-stop")).to_be_enabled()
    finally:
        os.kill(server.pid, signal.SIGCONT)
    expect(freshness).to_have_attribute("data-freshness", "fresh", timeout=15_000)


def test_bad_file_is_refused_in_words(page: Page, tmp_path: Path) -> None:
    console = Console(page, "horizontal-3")
    console.open()
    stored = page.request.get("/api/v1/trajectories").json()
    bad = tmp_path / "bad.csv"
    bad.write_text("time_s,yaw_deg,pitch_deg,roll_deg\n0.0,0,0,0\n0.1,1,nan,0\n0.2,2,0,0\n")
    console.upload(bad, "nue")
    alert = page.get_by_role("alert").filter(has_text="pitch_deg")
    expect(alert).to_contain_text("line 3")
    assert page.request.get("/api/v1/trajectories").json() == stored


def test_drag_and_drop(page: Page) -> None:
    Console(page, "horizontal-3").open()
    rows = "\n".join(f"{i / 100},{i / 50},{i / 40},0" for i in range(200))
    page.evaluate(
        """csv => {
            const data = new DataTransfer();
            data.items.add(new File([csv], "dropped.csv", { type: "text/csv" }));
            const zone = document.querySelector("input[type=file]").closest("label");
            zone.dispatchEvent(new DragEvent("drop", { dataTransfer: data, bubbles: true, cancelable: true }));
        }""",
        f"time_s,yaw_deg,pitch_deg,roll_deg\n{rows}\n",
    )
    flights = page.get_by_label("Flight", exact=True)
    expect(flights.locator("option:checked")).to_contain_text("dropped", timeout=10_000)
