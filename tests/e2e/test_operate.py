"""An operator flies a real flight on the simulated rig, in a real browser."""

import contextlib
import csv
import json
import math
import os
import re
import signal
import threading
import time
from collections.abc import Sequence
from pathlib import Path

import pytest
from playwright.sync_api import Page, expect

from tests.e2e.conftest import FLIGHT, TABLET, Pages, Server
from tests.e2e.console import FRAMES, SLOW_MS, SOON_MS, Console
from tests.e2e.picture import changed, colours, dominance
from tests.support.sockets import connect

pytestmark = pytest.mark.browser


def apart(one: Sequence[float], other: Sequence[float]) -> float:
    """How far the frame that is farthest is from where it was [deg]."""
    return max(abs(a - b) for a, b in zip(one, other, strict=True))


def test_flight_from_upload_to_replay(pages: Pages, shots: Path) -> None:
    page = pages.open(scene=True)
    console = Console(page, "vertical-4")
    console.open()
    console.expect_state("disconnected")
    scene = page.locator("iframe")
    # The machine is there before it flies: many colours, none over nearly all of the picture.
    console.until(lambda: colours(scene.screenshot()) > 100)
    page.screenshot(path=shots / "operate-first.png")
    console.fly(FLIGHT)

    # It flies: frames turn, and the solved angles reproduce the flight. No picture is taken before it is held: a slow
    # scene must not take the time of the flight.
    before = console.angles()
    solve, tracking = [], []

    def turned() -> bool:
        solve.append(console.error("solve"))
        tracking.append(console.error("tracking"))
        return len(solve) >= 20 and apart(before, console.angles()) > 1.0

    console.until(turned)
    assert max(solve) < 1e-9
    assert 0.0 < max(tracking) < 5.0

    # Space holds on the path, and never lets the rig go on: that takes the button.
    page.keyboard.press("Space")
    console.expect_state("held")
    console.at_rest()
    first = scene.screenshot(path=shots / "scene.png")
    assert dominance(first) < 0.97
    held_at, angles = console.path_time(), console.angles()
    page.wait_for_timeout(700)  # what must not happen is watched for a while
    assert console.path_time() == held_at
    assert apart(angles, console.angles()) < 0.05
    assert console.error("solve") < 1e-9
    page.keyboard.press("Space")
    page.wait_for_timeout(700)
    console.expect_state("held")
    assert console.path_time() == held_at
    console.button("resume").click()
    resumed: list[float] = []

    def went_on() -> bool:  # what it flies is read on the way: a slow page may find the flight at its end
        resumed.append(console.error("solve"))
        return console.path_time() > held_at + 0.5

    console.until(went_on)
    page.screenshot(path=shots / "operate-running-dark.png")
    console.until(lambda: changed(first, scene.screenshot()) > 0.002)  # the scene shows it, too
    console.put_scene_away()
    assert all(error < 1e-9 for error in resumed if math.isfinite(error))

    # E-stop latches; the way out is to acknowledge, then to reset.
    page.get_by_role("button", name="E-stop").click()
    console.expect_state("estopped")
    expect(console.button("reset")).to_be_hidden()
    expect(page.get_by_text("waits for acknowledge").first).to_be_visible()
    page.screenshot(path=shots / "operate-estopped.png")
    console.button("acknowledge").click()
    expect(console.button("acknowledge")).to_be_hidden()
    console.at_rest()
    console.give("reset", "idle")

    # What was flown is on record, and is seen again.
    page.get_by_role("navigation").get_by_role("link", name="Runs").click()
    flights = (
        page.get_by_role("row").filter(has_text="vertical-4").filter(has_not_text="incident")
    )  # a late tick is one
    row = flights.first
    expect(row).to_be_visible(timeout=SOON_MS)
    page.screenshot(path=shots / "runs-flown.png")
    row.get_by_role("button", name="Download").click()
    address = page.get_by_role("link", name="CSV .csv").get_attribute("href")
    assert address is not None
    exported = page.request.get(address)
    assert exported.ok
    rows = list(csv.DictReader(exported.text().splitlines()))
    ticks = [int(row["seq"]) for row in rows]
    assert ticks == list(range(ticks[0], ticks[0] + len(ticks)))
    assert len(ticks) > 1400  # at 1 kHz, of the 0.7 s each for which it was watched
    row.get_by_role("link").first.click()
    replayed(console, shots)


def replayed(console: Console, shots: Path) -> None:
    """The run plays by itself; its clock is paused, set and run faster."""
    page = console.page
    replay, at = page.get_by_test_id("replay"), page.get_by_test_id("at")

    def now() -> float:
        return float(at.get_attribute("data-value") or "nan")

    expect(console.state).to_have_attribute("data-state", re.compile(r"\w+"), timeout=SLOW_MS)
    expect(page.get_by_test_id("replay-badge")).to_be_visible()
    console.until(lambda: now() > 0.5)
    # Where nothing runs, Space is the playback's.
    page.keyboard.press("Space")
    expect(replay).to_have_attribute("data-playing", "false")
    page.keyboard.press("Home")
    # The playhead goes ahead of what the server sends: the run begins where the rig stood at first, at zero.
    console.until(lambda: now() == 0.0 and max(map(abs, console.angles())) < 0.01)
    start = console.angles()
    page.get_by_label("Time", exact=True).fill("3")
    console.until(lambda: abs(now() - 3.0) < 0.05 and apart(start, console.angles()) > 1.0)
    assert console.error("solve") < 1e-9
    page.get_by_label("Speed").select_option("4")
    page.get_by_role("button", name="Play").click()
    console.until(lambda: now() > 3.5)
    page.screenshot(path=shots / "run-replay.png")


def test_two_consoles_at_one_rig(page: Page, pages: Pages, shots: Path) -> None:
    flown = Console(page, "vertical-limited")
    flown.open()
    watched = Console(pages.open(), "vertical-limited")
    watched.open()
    flown.fly(FLIGHT)

    # A question to the operator stops neither the page, which keeps the lease, nor the keyboard; Space only ever holds.
    page.get_by_role("navigation", name="Pages").get_by_role("link", name="Flights").click()
    page.get_by_role("button", name="Delete the flight").click()
    question = page.get_by_role("dialog")
    expect(question).to_be_visible()
    page.get_by_role("button", name=re.compile("^Stop")).click(trial=True)
    page.wait_for_timeout(6000)  # a holder is silent after 5 s
    watched.expect_state("running")
    page.keyboard.press("Space")
    watched.expect_state("held")
    expect(question).to_be_visible()
    page.keyboard.press("Space")
    page.wait_for_timeout(700)
    watched.expect_state("held")
    question.get_by_role("button", name="Cancel").click()
    expect(question).to_be_hidden()
    page.get_by_role("navigation", name="Pages").get_by_role("link", name="Operate").click()
    flown.give("resume", "running")

    # Who only watches can stop, but not command, and is told who commands, on a tablet too.
    watched.expect_state("running")
    watched.page.set_viewport_size(TABLET)
    holder = watched.page.get_by_test_id("lease").locator("b")
    expect(holder).to_be_visible()
    expect(holder).to_have_text(re.compile(r"console-\w+"))
    expect(watched.page.get_by_role("button", name="Ask for control")).to_be_visible()
    expect(watched.button("hold")).to_be_disabled()
    watched.page.keyboard.press("Escape")
    flown.expect_state("armed")
    expect(watched.button("start")).to_be_disabled()

    # By hand: all frames to a pose, then one of them a step on.
    flown.button("move").click()
    dialog = page.get_by_role("dialog")
    pose = [5.0, -4.0, 3.0, -2.0]
    for name, target in zip(FRAMES, pose, strict=True):
        dialog.get_by_label(name, exact=True).fill(str(target))
    dialog.get_by_role("button", name="Move", exact=True).click()
    flown.until(lambda: apart(flown.angles(), pose) < 0.05)
    flown.expect_state("armed")
    flown.button("move").click()
    dialog.get_by_label("Jog by").select_option("5")
    page.screenshot(path=shots / "operate-jog.png")
    dialog.get_by_role("button", name="Jog outer up").click()
    pose[1] += 5.0
    flown.until(lambda: apart(flown.angles(), pose) < 0.05)
    flown.expect_state("armed")
    dialog.get_by_role("button", name="Close").click()
    expect(dialog).to_be_hidden()

    # Control is asked for and handed over, and a reload of the page keeps it.
    watched.page.get_by_role("button", name="Ask for control").click()
    expect(page.get_by_text(re.compile(r"console-\w+ asks"))).to_be_visible()
    # It could be taken too: a question first, which nothing stands still for.
    watched.page.get_by_role("button", name="Take over").click()
    taking = watched.page.get_by_role("dialog")
    expect(taking).to_contain_text(re.compile(r"Take control from console-\w+"))
    watched.page.get_by_role("button", name="E-stop").click(trial=True)
    taking.get_by_role("button", name="Cancel").click()
    page.get_by_role("button", name="Hand over").click()
    expect(watched.page.get_by_test_id("lease")).to_have_attribute("data-held", "true")
    expect(page.get_by_test_id("lease")).to_have_attribute("data-held", "false")
    watched.give("disarm", "ready")
    watched.page.reload()
    expect(watched.page.get_by_test_id("lease")).to_have_attribute("data-held", "true", timeout=SOON_MS)
    watched.page.get_by_role("button", name="Release").click()
    expect(page.get_by_role("button", name="Take control")).to_be_visible()


def swing(address: str, rig: str, key: str, over: threading.Event) -> None:
    """A live source: a small swing from rest, a sample every 10 ms, until it is over."""
    url = f"{address.replace('http', 'ws', 1)}/api/v1/rigs/{rig}/live"
    with connect(url, proxy=None, compression=None) as link:
        link.send(json.dumps({"type": "open", "key": key}))
        begun = time.monotonic()
        while not over.wait(0.01):
            t = time.monotonic() - begun
            angle = 20.0 * min(1.0, t / 3.0) ** 3 * math.sin(t)
            link.send(json.dumps({"type": "sample", "time_s": t, "euler_deg": [angle, 0.5 * angle, -angle]}))
            with contextlib.suppress(TimeoutError):
                while True:
                    link.recv(timeout=0.0)


def test_a_live_source_is_followed_until_it_is_gone(page: Page, server: Server, shots: Path) -> None:
    console = Console(page, "horizontal-4")
    console.open()
    console.take_control()
    console.give("connect", "idle")
    page.get_by_role("button", name="Live source").click()
    ahead = page.get_by_label("Seconds told ahead")
    page.get_by_label("Live method").select_option("exact")
    expect(ahead).to_be_hidden()
    page.get_by_label("Live method").select_option("preview")
    ahead.fill("0.2")
    page.get_by_role("button", name="Load live").click()
    console.expect_state("ready")
    live = page.get_by_test_id("live")
    expect(live).to_have_text("loaded, not flown")
    key = page.get_by_test_id("live-key").inner_text()
    page.screenshot(path=shots / "operate-live-key.png")
    console.give("arm", "armed")
    expect(console.button("start")).to_be_hidden()
    over = threading.Event()
    source = threading.Thread(target=swing, args=(server.url, "horizontal-4", key, over))
    source.start()
    try:
        console.give("go_live", "live")
        expect(live).to_have_text("followed", timeout=SOON_MS)
        before = console.angles()
        console.until(lambda: apart(before, console.angles()) > 1.0)
        console.until(lambda: math.isfinite(console.error("solve")))  # how small it is, a loop on a made-up clock tells
        expect(page.get_by_test_id("live-figures")).to_have_text(re.compile(r"\d+ Hz · \d+ ms (ahead|late)"))
        page.screenshot(path=shots / "operate-live.png")
    finally:
        over.set()
        source.join()
    # A source that goes is a controlled stop, with its alarm.
    console.expect_state("armed")
    expect(page.get_by_text("waits for acknowledge").first).to_be_visible()


def test_stale_data_disables_motion_but_never_stop(page: Page, server: Server) -> None:
    console = Console(page, "vertical-3")
    console.open()
    console.take_control()
    console.give("connect", "idle")
    freshness = page.locator("[data-freshness]")
    expect(freshness).to_have_attribute("data-freshness", "fresh", timeout=SOON_MS)
    os.kill(server.pid, signal.SIGSTOP)
    try:
        expect(freshness).to_have_attribute("data-freshness", "stale", timeout=SOON_MS)
        expect(page.get_by_role("alert").filter(has_text="Motion is disabled")).to_be_visible()
        expect(console.state).to_have_attribute("data-old", "true")
        expect(console.state).to_contain_text("last known")
        for name in ("arm", "start", "move", "home"):
            expect(console.button(name)).to_be_disabled()
        expect(page.get_by_role("button", name=re.compile("^Stop"))).to_be_enabled()
        expect(page.get_by_role("button", name="E-stop")).to_be_enabled()
    finally:
        os.kill(server.pid, signal.SIGCONT)
    expect(freshness).to_have_attribute("data-freshness", "fresh", timeout=SOON_MS)
    expect(console.state).to_have_attribute("data-old", "false")


def test_files_are_dropped_or_refused_in_words(page: Page, tmp_path: Path) -> None:
    console = Console(page, "horizontal-3")
    console.open()
    stored = page.request.get("/api/v1/trajectories").json()
    bad = tmp_path / "bad.csv"
    bad.write_text("time_s,yaw_deg,pitch_deg,roll_deg\n0.0,0,0,0\n0.1,1,nan,0\n0.2,2,0,0\n")
    console.upload(bad, "nue")
    alert = page.get_by_role("alert").filter(has_text="pitch_deg")
    expect(alert).to_contain_text("line 3", timeout=SOON_MS)
    assert page.request.get("/api/v1/trajectories").json() == stored

    rows = "\n".join(f"{i / 100},{i / 50},{i / 40},0" for i in range(200))
    page.evaluate(
        """csv => {
            const data = new DataTransfer();
            data.items.add(new File([csv], "dropped.csv", { type: "text/csv" }));
            // Beside the zone that asks for it.
            const init = { dataTransfer: data, bubbles: true, cancelable: true };
            document.querySelector("header").dispatchEvent(new DragEvent("drop", init));
        }""",
        f"time_s,yaw_deg,pitch_deg,roll_deg\n{rows}\n",
    )
    flights = page.get_by_label("Flight", exact=True)
    expect(flights.locator("option:checked")).to_contain_text("dropped", timeout=SOON_MS)
