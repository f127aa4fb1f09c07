"""Curves of runs over HTTP, on the real server: made once, decoded here by what its page says, and kept."""

import struct
from typing import Any

import httpx
import numpy as np
import pytest

from fullpose_server.runtime.recording.mcap_reader import read_samples
from tests.fullpose_server.api.live_server import LiveServer
from tests.support.waiting import until


def curves(server: LiveServer, run: str, **query: str) -> dict[str, Any]:
    answers: list[httpx.Response] = []

    def ready() -> bool:
        answers.append(server.http.get(f"/runs/{run}/curves", params=query))
        assert answers[-1].status_code in (200, 202), answers[-1].text
        assert answers[-1].json()["ready"] == (answers[-1].status_code == 200)
        return answers[-1].status_code == 200

    until(ready)
    return dict(answers[-1].json())


def window(
    server: LiveServer, run: str, columns: list[str], **query: float | str
) -> tuple[dict[str, np.ndarray], dict[str, np.ndarray]]:
    """(least, greatest) by column."""
    answer = server.http.get(f"/runs/{run}/curves/window", params=query)
    assert answer.status_code == 200, answer.text
    magic, count, buckets, samples = struct.unpack_from("<4sIII", answer.content)
    assert (magic, count) == (b"FPC1", len(columns))
    values = np.frombuffer(answer.content, "<f8", offset=16).reshape(count, 1 if samples else 2, buckets)
    return (
        {name: values[k, 0] for k, name in enumerate(columns)},
        {name: values[k, -1] for k, name in enumerate(columns)},
    )


def test_a_run_is_drawn_at_any_width_as_it_was_recorded(server: LiveServer, run: str) -> None:
    rows = read_samples(server.settings.data_dir / "runs" / f"{run}.mcap")
    about = curves(server, run)
    assert (about["samples"], about["against"]) == (len(rows), None)
    kinds = [event["kind"] for event in about["events"]]
    assert {"begin", "command", "transition", "end"} <= set(kinds)
    assert any(event["text"] == "armed → positioning" for event in about["events"]) or "transition" in kinds
    span = {"from_s": 0.0, "to_s": about["duration_s"]}
    for width in (7, 100, 4000):
        least, greatest = window(server, run, about["columns"], **span, width=width)
        assert least["time_s"][0] == 0.0
        assert greatest["time_s"][-1] == pytest.approx(about["duration_s"])
        for name, values in (
            ("measured_outer_deg", rows["measured"][:, 1]),
            ("tracking_error_deg", rows["tracking_error_deg"]),
        ):
            assert np.nanmin(least[name]) == np.nanmin(values)
            assert np.nanmax(greatest[name]) == np.nanmax(values)
        assert len(least["time_s"]) <= 4 * width
    at = about["duration_s"] / 2
    least, greatest = window(server, run, about["columns"], from_s=at, to_s=at + 0.1, width=100)
    np.testing.assert_array_equal(least["demand_inner_deg"], greatest["demand_inner_deg"])
    assert (server.settings.data_dir / "curves" / run / "about.json").exists()


def test_a_run_against_itself_and_against_its_plan(server: LiveServer, run: str) -> None:
    plan = server.http.get(f"/runs/{run}").json()["plan_id"]
    for other, most in ((f"run:{run}", 1e-9), (f"plan:{plan}", 0.5)):
        about = curves(server, run, against=other)["against"]
        assert (about["kind"], about["aligned"]) == (other.split(":")[0], "flight")
        least, greatest = window(server, run, about["columns"], from_s=0.0, to_s=1e6, width=500, against=other)
        for frame in ("base", "outer", "middle", "inner"):
            assert np.isfinite(least[f"difference_{frame}_deg"]).any()
            assert np.nanmax(np.abs([least[f"difference_{frame}_deg"], greatest[f"difference_{frame}_deg"]])) <= most


def test_what_cannot_be_drawn_is_told(server: LiveServer, run: str) -> None:
    for path, status in (
        ("/runs/nothing/curves", 404),
        (f"/runs/{run}/curves?against=run:nothing", 404),
        (f"/runs/{run}/curves?against=plan:nothing", 404),
        (f"/runs/{run}/curves?against=rig:nothing", 422),
        (f"/runs/{run}/curves/window?from_s=2&to_s=1", 422),
        (f"/runs/{run}/curves/window?from_s=0&to_s=nan", 422),
        (f"/runs/{run}/curves/window?from_s=0&to_s=1&width=100000", 422),
    ):
        answer = server.http.get(path)
        assert answer.status_code == status, path
        assert answer.json()["detail"]
