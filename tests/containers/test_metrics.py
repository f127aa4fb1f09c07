"""Prometheus of the distribution on the committed files: it scrapes the server, and answers what the dashboard asks."""

import json
import time
from collections.abc import Iterator
from typing import Any

import httpx
import pytest

from tests.containers.composed import arguments, service
from tests.containers.engine import PEERS, Box, Engine
from tests.containers.flights import FILE, RIG
from tests.docker.dashboards import expressions
from tests.support.waiting import until

PORT = 9090


@pytest.fixture(scope="module")
def scraped(engine: Engine, tmp_path_factory: pytest.TempPathFactory) -> Iterator[tuple[Box, httpx.Client]]:
    """A server with a rig, and Prometheus's API once it has scraped it a few times."""
    with engine.server(rig=FILE) as box:
        box.wait_healthy()
        with httpx.Client(base_url=f"{box.url}/api/v1", headers=box.headers, timeout=180.0) as http:
            http.post(f"/rigs/{RIG}/lease", json={"action": "take"}).raise_for_status()
            http.get("/nothing")
        token = tmp_path_factory.mktemp("secret") / "token"
        token.write_text(box.token)
        given = {"METRICS_TOKEN_FILE": str(token)}
        options = (
            *arguments("prometheus", engine.volumes("prometheus"), given),
            "--add-host",
            f"fullpose:{box.address}",
        )
        command = ("/usr/bin/prometheus", *service("prometheus")["command"])
        beside = engine.start(PEERS, *options, command=command)
        with httpx.Client(base_url=f"http://{beside.address}:{PORT}/api/v1", timeout=30.0) as prometheus:
            until(lambda: _scrapes(prometheus) >= 3, every_s=0.5)
            yield box, prometheus


def _scrapes(prometheus: httpx.Client) -> int:
    try:
        answer = prometheus.get("/query", params={"query": 'count_over_time(up{job="fullpose"}[5m])'}).json()
    except (httpx.TransportError, json.JSONDecodeError):
        return 0
    return int(answer["data"]["result"][0]["value"][1]) if answer["data"]["result"] else 0


def asked(prometheus: httpx.Client, expression: str) -> list[dict[str, Any]]:
    """What it answers now."""
    answer = prometheus.get("/query", params={"query": expression, "time": time.time()}).json()
    assert answer["status"] == "success", (expression, answer)
    found: list[dict[str, Any]] = answer["data"]["result"]
    return found


def test_the_server_is_a_target_that_is_up(scraped: tuple[Box, httpx.Client]) -> None:
    _, prometheus = scraped
    (target,) = prometheus.get("/targets").json()["data"]["activeTargets"]
    assert (target["health"], target["lastError"]) == ("up", "")


@pytest.mark.parametrize(("title", "expression"), expressions(), ids=[title for title, _ in expressions()])
def test_every_panel_has_data(scraped: tuple[Box, httpx.Client], title: str, expression: str) -> None:
    _, prometheus = scraped
    assert asked(prometheus, expression.replace("$rig", ".*")), title


def test_every_alert_is_evaluated_and_none_fires_on_a_server_that_is_well(scraped: tuple[Box, httpx.Client]) -> None:
    _, prometheus = scraped
    (group,) = prometheus.get("/rules").json()["data"]["groups"]
    until(lambda: all(rule["health"] == "ok" for rule in _rules(prometheus)))
    assert len(group["rules"]) == 8
    firing = [rule["name"] for rule in _rules(prometheus) if rule["state"] != "inactive"]
    assert set(firing) <= {"DeadlinesMissed"}  # a starved machine


def _rules(prometheus: httpx.Client) -> list[dict[str, Any]]:
    rules: list[dict[str, Any]] = prometheus.get("/rules").json()["data"]["groups"][0]["rules"]
    return rules
