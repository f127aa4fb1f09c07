"""The committed schema of rig files is the code's, and knows what the guide writes."""

import json
import tomllib

import pytest

from fullpose.rig import builtin_rigs
from fullpose_server.formats.rig_document import RigDocument
from fullpose_server.formats.rig_toml import rig_toml
from fullpose_server.formats.toml_text import toml
from tools.rig_schema import TARGET, schema


def test_the_committed_schema_is_the_code_s() -> None:
    assert json.loads(TARGET.read_text(encoding="utf-8")) == schema(), "run python -m tools.rig_schema"


def test_every_table_names_its_keys_and_refuses_others() -> None:
    tables = [RigDocument.model_json_schema(), *RigDocument.model_json_schema()["$defs"].values()]
    objects = [table for table in tables if table.get("type") == "object"]
    assert len(objects) >= 11
    assert {table["title"] for table in objects if table.get("additionalProperties") is not False} == {"DriveTable"}


ALL = """name = "bench"
geometry = "vertical-4"

[frames.base]
max_rate_deg_s = 200.0

[payload]
size_m = [0.3, 0.2, 0.1]

[drive]
name = "acme"
address = "10.0.0.7"

[guard.following_deg]
warn = 0.5
trip = 2.0

[silence.owner]
disarm_s = 90.0

[process]
realtime_priority = false
"""


def test_a_document_is_written_as_it_was_read() -> None:
    assert toml(RigDocument.model_validate(tomllib.loads(ALL))) == ALL


@pytest.mark.parametrize("rig", builtin_rigs().values(), ids=str)
def test_what_is_written_has_the_schema(rig: object) -> None:
    RigDocument.model_validate(tomllib.loads(rig_toml(rig)))  # type: ignore[arg-type]
