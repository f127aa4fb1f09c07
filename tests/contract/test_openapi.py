"""The committed contract is the server's own; the console's types are generated from it."""

import json
from pathlib import Path

from fullpose_server.app import create_app
from fullpose_server.settings import Settings

COMMITTED = Path(__file__).parents[2] / "docs" / "openapi.json"


def test_the_committed_contract_is_what_the_app_says(tmp_path: Path) -> None:
    now = create_app(Settings(data_dir=tmp_path)).openapi()
    # The version is the package's and changes at every release.
    committed = json.loads(COMMITTED.read_text(encoding="utf-8"))
    now["info"]["version"] = committed["info"]["version"]
    assert now == committed, "the API has changed: run python -m tools.openapi, then generate the types in web/"


def test_every_error_is_a_problem_document() -> None:
    document = json.loads(COMMITTED.read_text(encoding="utf-8"))
    assert len(document["paths"]) > 20
    for path, operations in document["paths"].items():
        for method, operation in operations.items():
            assert operation["responses"]["default"]["content"].keys() == {"application/problem+json"}, (path, method)
            assert "HTTPValidationError" not in json.dumps(operation)
