"""The committed dashboard, as data."""

import json
import re
from typing import Any

from tests.support.repository import ROOT

DASHBOARD = ROOT / "docker" / "grafana" / "dashboards" / "fullpose.json"
NAME = re.compile(r"\bfullpose_\w+")


def dashboard() -> dict[str, Any]:
    loaded: dict[str, Any] = json.loads(DASHBOARD.read_text())
    return loaded


def expressions() -> list[tuple[str, str]]:
    """(the panel's title, the query) of every panel."""
    return [
        (panel["title"], target["expr"])
        for panel in dashboard()["panels"]
        if panel["type"] != "row"
        for target in panel["targets"]
    ]
