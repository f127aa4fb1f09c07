"""A recorded run played again, over the stream's protocol and in a scene of its own."""

import contextlib
import json
from pathlib import Path
from typing import Any

import httpx
import numpy as np
import pytest
from websockets.exceptions import InvalidStatus
from websockets.sync.client import ClientConnection

from fullpose.kinematics import payload_attitude
from fullpose.rig import FRAMES, builtin_rigs
from fullpose_server.api.routes.replay import MOST_REPLAYS
from fullpose_server.runtime.contract.telemetry import SAMPLE
from fullpose_server.runtime.recording.mcap_reader import read_samples
from fullpose_server.runtime.recording.playback import PlaybackError, RunPlayback
from fullpose_server.session.states import STATES
from tests.fullpose_server.api.live_server import LiveServer
from tests.fullpose_server.api.test_stream import received, subscribe
from tests.fullpose_server.scene.browser_side import Viewer
from tests.support.sockets import connect
from tests.support.waiting import until


def replay(server: LiveServer, run: str, **options: Any) -> ClientConnection:
    return connect(f"{server.ws}/runs/{run}/stream", **options)


def say(stream: ClientConnection, kind: str, **fields: Any) -> None:
    stream.send(json.dumps({"type": kind} | fields))


def rows_of(server: LiveServer, run: str) -> np.ndarray:
    return read_samples(server.settings.data_dir / "runs" / f"{run}.mcap")


def test_every_sample_comes_again_in_order_and_then_it_stands(server: LiveServer, run: str) -> None:
    rows = rows_of(server, run)
    with replay(server, run) as stream:
        hello = received(stream, "hello")
        assert (hello["schema"], hello["rig"], hello["replay"]["run"]) == ("fullpose.stream/1", "vertical-4", run)
        assert hello["session"]["allowed"] == []
        assert hello["record"]["size"] == SAMPLE.itemsize
        duration = hello["replay"]["duration_s"]
        assert duration == pytest.approx((rows["time_ns"][-1] - rows["time_ns"][0]) / 1e9)
        say(stream, "speed", factor=4.0)
        assert received(stream, "replay")["factor"] == 4.0
        subscribe(stream, every_sample=True, since_seq=0, encoding="binary", rate_hz=100)
        got: list[np.ndarray] = []
        states, end = [""], None
        # The session as it is now, not every change of it: positioning may be shorter than a look.
        last = STATES[rows["state"][-1]]
        while end is None or not got or got[-1]["seq"][-1] != rows["seq"][-1] or states[-1] != last:
            data = stream.recv(timeout=10.0)
            if isinstance(data, bytes):
                got.append(np.frombuffer(data, SAMPLE, offset=32))
                continue
            message = json.loads(data)
            if message["type"] == "session":
                states.append(message["session"]["state"])
            elif message["type"] == "replay" and not message["playing"]:
                end = message
        assert end["time_s"] == pytest.approx(duration)
    played = np.concatenate(got)
    for name in SAMPLE.names or ():
        np.testing.assert_array_equal(played[name], rows[name], err_msg=name)
    assert "running" in states


def test_seek_shows_that_instant_at_once_and_pause_stays_there(server: LiveServer, run: str) -> None:
    rows = rows_of(server, run)
    time_s = (rows["time_ns"] - rows["time_ns"][0]) / 1e9
    with replay(server, run) as stream:
        say(stream, "pause")
        assert received(stream, "replay") == {"type": "replay", "time_s": 0.0, "playing": False, "factor": 1.0}
        subscribe(stream, topics=["telemetry"])
        for wanted in (1.7, 0.4, float(time_s[-1])):
            say(stream, "seek", time_s=wanted)
            assert received(stream, "replay")["time_s"] == wanted
            row = rows[np.searchsorted(time_s, wanted + 1e-9, side="right") - 1]
            # Frames that were under way may come first; the last one is the instant's, and nothing follows it.
            frame = received(stream, "telemetry")
            while frame["seq"] != row["seq"]:
                frame = received(stream, "telemetry")
            assert frame["measured"] == [pytest.approx(row["measured"].tolist())]
            assert frame["state"] == [row["state"]]
            with pytest.raises(TimeoutError):
                stream.recv(timeout=0.15)
        say(stream, "play")  # at the end: from the beginning
        assert received(stream, "replay")["playing"] is True
        assert received(stream, "telemetry")["seq"] < rows["seq"][0] + 0.3 * len(rows)


def test_what_a_run_does_not_have_is_told_and_changes_nothing(server: LiveServer, run: str) -> None:
    with replay(server, run) as stream:
        say(stream, "pause")
        received(stream, "replay")
        for kind, fields in (
            ("seek", {"time_s": 1e6}),
            ("seek", {"time_s": -1}),
            ("speed", {"factor": 0}),
            ("warp", {}),
        ):
            say(stream, kind, **fields)
            assert received(stream, "problem")["problem"]["status"] == 422
        say(stream, "seek", time_s=0.5)
        assert received(stream, "replay") == {"type": "replay", "time_s": 0.5, "playing": False, "factor": 1.0}
    with server.stream() as live:
        live.send(json.dumps({"type": "pause"}))
        assert "watched" in received(live, "problem")["problem"]["detail"]


def test_runs_and_pages_that_get_no_replay(server: LiveServer, run: str) -> None:
    with pytest.raises(InvalidStatus) as refused, replay(server, "nothing"):
        pass
    assert refused.value.response.status_code == 404
    broken = server.settings.data_dir / "runs" / "broken.mcap"
    broken.write_bytes(b"no record")
    with pytest.raises(InvalidStatus) as refused, replay(server, "broken"):
        pass
    broken.unlink()
    assert refused.value.response.status_code == 422
    with pytest.raises(InvalidStatus) as refused, replay(server, run, origin="http://evil.example"):
        pass
    assert refused.value.response.status_code == 403


def test_its_scene_shows_the_run_and_goes_with_the_client(server: LiveServer, run: str) -> None:
    rows = rows_of(server, run)
    with replay(server, run) as stream:
        scene = received(stream, "hello")["replay"]["scene"]
        say(stream, "pause")
        say(stream, "seek", time_s=1.5)
        received(stream, "replay")
        at = rows["time_ns"][0] + 1_500_000_000
        row = rows[np.searchsorted(rows["time_ns"], at, side="right") - 1]
        F = np.empty((3, 3))
        payload_attitude(builtin_rigs()["vertical-4"].axes, np.radians(row["measured"]), F)
        with Viewer(f"ws{server.url[4:]}{scene}") as browser:
            browser.until(
                lambda seen: (
                    "/machine/base/outer/middle/inner" in seen.nodes
                    and bool(np.abs(seen.quaternion("machine", *FRAMES) - F.T).max() < 1e-4)
                )
            )
        assert httpx.get(f"{server.url}{scene}").status_code == 200
    until(lambda: httpx.get(f"{server.url}{scene}").status_code == 404)


def test_the_clock_of_a_replay(server: LiveServer, run: str) -> None:
    now = 100.0
    path: Path = server.settings.data_dir / "runs" / f"{run}.mcap"
    playback = RunPlayback(path, clock=lambda: now)
    assert playback.position == (0.0, False, 1.0)
    now += 5.0
    assert playback.position[0] == 0.0
    playback.play()
    now += 0.5
    assert playback.position[0] == pytest.approx(0.5)
    playback.speed(2.0)
    now += 0.25
    assert playback.position[0] == pytest.approx(1.0)
    playback.pause()
    now += 9.0
    assert playback.position[:2] == (pytest.approx(1.0), False)
    playback.seek(0.25)
    playback.play()
    now += 1e6
    assert playback.position == (playback.duration_s, False, 2.0)
    latest = playback.latest()
    assert latest is not None
    assert latest["seq"][0] == rows_of(server, run)["seq"][-1]
    for wrong in (-1e-9, playback.duration_s + 1e-6, float("nan")):
        with pytest.raises(PlaybackError):
            playback.seek(wrong)
    rows = rows_of(server, run)  # a starved machine misses ticks
    ticks = int(rows["tick"][-1]) - int(rows["tick"][0])
    assert playback.rate_hz == pytest.approx(ticks / playback.duration_s)
    assert playback.rate_hz <= 1.05 * server.settings.rig_rate_hz


def test_so_many_records_are_played_at_once_and_no_more(server: LiveServer, run: str) -> None:
    with contextlib.ExitStack() as open_:
        for _ in range(MOST_REPLAYS):
            received(open_.enter_context(replay(server, run)), "hello")
        with pytest.raises(InvalidStatus) as refused:
            replay(server, run).close()
        assert refused.value.response.status_code == 503

    def admitted() -> bool:
        try:
            with replay(server, run) as stream:
                received(stream, "hello")
        except InvalidStatus:
            return False
        return True

    until(admitted)  # the last one's end may take the server a moment
