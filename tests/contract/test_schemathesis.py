"""Every route, asked what its contract allows and what it does not, by Schemathesis, on a store with data.

No answer may be an error of the server, or one that the contract does not name: the catch-all `default` of each
operation is taken out of the document first. Longer: `SCHEMATHESIS_EXAMPLES=100 pytest tests/contract`.
"""

import json
import os
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

from tests.fullpose_server.api.live_server import Operator, live_server

COMMITTED = Path(__file__).parents[2] / "docs" / "openapi.json"
EXAMPLES = os.environ.get("SCHEMATHESIS_EXAMPLES", "2")
CHECKS = (
    "not_a_server_error",
    "status_code_conformance",
    "content_type_conformance",
    "response_schema_conformance",
    "response_headers_conformance",
    "unsupported_method",
    "allow_header_conformance",
)


def explicit() -> dict[str, Any]:
    """The contract without what would excuse an answer that it does not name."""
    document: dict[str, Any] = json.loads(COMMITTED.read_text("utf-8"))
    for operations in document["paths"].values():
        for operation in operations.values():
            del operation["responses"]["default"]
    _same_items(document)
    return document


def _same_items(node: Any) -> None:
    """Schemathesis 4.32 trips over tuples inside of lists: four numbers in a row are a list of four numbers."""
    for value in node.values() if isinstance(node, dict) else node if isinstance(node, list) else ():
        _same_items(value)
    if (
        isinstance(node, dict)
        and "prefixItems" in node
        and all(one == node["prefixItems"][0] for one in node["prefixItems"])
    ):
        node["items"] = node.pop("prefixItems")[0]


@pytest.mark.slow
def test_no_answer_is_undocumented(tmp_path: Path) -> None:
    document = tmp_path / "openapi.json"
    document.write_text(json.dumps(explicit()), "utf-8")
    with live_server(tmp_path / "data", rig_rate_hz=500.0) as server:
        plan = server.plan()
        body = {"trajectory": plan["trajectory"], "rig": "vertical-4", "methods": ["exact"]}
        assert server.http.post("/compare", json=body).status_code == 202
        operator = Operator(server)
        operator.to_idle()
        operator.command("load", plan=plan["id"])
        operator.command("arm")
        operator.command("start")
        operator.wait("running")
        operator.wait("armed")
        asked = subprocess.run(
            [
                str(Path(sys.executable).with_name("st")),
                *("run", str(document), "--url", server.url, "--no-color", "--generation-database", "none"),
                *("--seed", "1", "-n", EXAMPLES, "--request-timeout", "60", "--checks", ",".join(CHECKS)),
                *("--warnings", "off", "--continue-on-failure", "--suppress-health-check", "all"),
            ],
            cwd=tmp_path,
            capture_output=True,
            text=True,
            check=False,
        )
    assert asked.returncode == 0, asked.stdout + asked.stderr
