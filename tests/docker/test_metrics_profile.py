"""Prometheus and Grafana as compose starts them: every file is there, and every metric is one that a server has."""

import json
import re
from pathlib import Path
from typing import Any

import pytest
import yaml

from tests.docker.dashboards import NAME, dashboard, expressions
from tests.docker.test_docker import compose, default
from tests.fullpose_server.api.live_server import live_server
from tests.support.repository import ROOT

DOCKER = ROOT / "docker"
ALERTS = yaml.safe_load((DOCKER / "prometheus" / "alerts.yaml").read_text())["groups"][0]["rules"]
CONFIG = yaml.safe_load((DOCKER / "prometheus" / "prometheus.yaml").read_text())


def services() -> dict[str, Any]:
    found: dict[str, Any] = compose()["services"]
    return {name: service for name, service in found.items() if service.get("profiles") == ["metrics"]}


def mounted(service: str) -> dict[str, Path]:
    """Folders of the repository by where the service has them."""
    mounts = [default(volume).split(":") for volume in services()[service]["volumes"]]
    return {mount[1]: DOCKER / mount[0] for mount in mounts if mount[0].startswith(".")}


def inside(service: str, path: str) -> Path:
    """The repository's file for one of the service's."""
    for place, folder in mounted(service).items():
        if path.startswith(f"{place}/"):
            return folder / path.removeprefix(f"{place}/")
    raise AssertionError(f"{service} has no {path}")


def test_the_profile_is_both() -> None:
    assert set(services()) == {"prometheus", "grafana"}
    assert services()["grafana"]["depends_on"] == ["prometheus"]


def test_what_prometheus_is_told_is_there() -> None:
    command = dict(word.split("=", 1) for word in services()["prometheus"]["command"])
    assert inside("prometheus", command["--config.file"]).is_file()
    for rules in CONFIG["rule_files"]:
        assert inside("prometheus", rules).is_file()
    (scraped,) = CONFIG["scrape_configs"]
    (target,) = scraped["static_configs"][0]["targets"]
    assert target.split(":")[0] in compose()["services"]


def test_what_grafana_is_told_is_there() -> None:
    environment = services()["grafana"]["environment"]
    assert inside("grafana", environment["GF_DASHBOARDS_DEFAULT_HOME_DASHBOARD_PATH"]).is_file()
    provisioning = mounted("grafana")["/etc/grafana/provisioning"]
    (source,) = yaml.safe_load((provisioning / "datasources" / "prometheus.yaml").read_text())["datasources"]
    assert source["uid"] == "prometheus"
    assert re.fullmatch(r"http://(\w+):9090", source["url"]).group(1) in services()  # type: ignore[union-attr]
    (provider,) = yaml.safe_load((provisioning / "dashboards" / "fullpose.yaml").read_text())["providers"]
    assert mounted("grafana")[provider["options"]["path"]].is_dir()


def test_panels_stand_beside_each_other_and_ask_the_source_that_is_provisioned() -> None:
    cells = set[tuple[int, int]]()
    for panel in dashboard()["panels"]:
        at = panel["gridPos"]
        own = {(x, y) for x in range(at["x"], at["x"] + at["w"]) for y in range(at["y"], at["y"] + at["h"])}
        assert not own & cells, panel["title"]
        assert max(x for x, _ in own) < 24
        cells |= own
    identifiers = [panel["id"] for panel in dashboard()["panels"]]
    assert len(set(identifiers)) == len(identifiers)
    sources = re.findall(r'"type": "prometheus",\s*"uid": "(\w+)"', json.dumps(dashboard()))
    assert set(sources) == {"prometheus"}


@pytest.fixture(scope="module")
def exposed(tmp_path_factory: pytest.TempPathFactory) -> set[str]:
    """Names of the series that a real server has."""
    with live_server(tmp_path_factory.mktemp("data")) as server:
        server.http.get("/health")
        text = server.http.get("/metrics").text
    kinds = dict(re.findall(r"^# TYPE (\w+) (\w+)$", text, re.MULTILINE))
    parts = {f"{name}_{part}" for name, kind in kinds.items() if kind == "histogram" for part in ("bucket", "count")}
    return set(kinds) | parts


@pytest.mark.parametrize(("title", "expression"), expressions(), ids=[title for title, _ in expressions()])
def test_what_a_panel_asks_for_there_is(exposed: set[str], title: str, expression: str) -> None:
    names = set(NAME.findall(expression))
    assert names <= exposed, title
    assert names or "up{" in expression or "ALERTS" in expression


@pytest.mark.parametrize("alert", ALERTS, ids=lambda alert: alert["alert"])
def test_what_an_alert_asks_for_there_is(exposed: set[str], alert: dict[str, Any]) -> None:
    assert set(NAME.findall(alert["expr"])) <= exposed
    assert alert["annotations"]["summary"]


def test_the_dashboard_shows_what_an_operator_needs() -> None:
    shown = {name for _, expression in expressions() for name in NAME.findall(expression)}
    assert {
        *("fullpose_rig_lateness_seconds", "fullpose_rig_deadline_misses_total", "fullpose_session_state"),
        *("fullpose_disk_free_bytes", "fullpose_request_seconds_bucket", "fullpose_recorder_alive"),
        *("fullpose_recorder_lost_samples_total", "fullpose_jobs_pending", "fullpose_alarms"),
    } <= shown
