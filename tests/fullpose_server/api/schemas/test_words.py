"""The wire's words are the session's and the record's own: what is added there is on the wire, without being typed."""

from pathlib import Path
from typing import Any

import pytest

from fullpose.rig import Frame, Geometry, Limit
from fullpose.vocabulary import RemedyKind
from fullpose_server.app import create_app
from fullpose_server.runtime.contract.telemetry import SAMPLE
from fullpose_server.session.alarms import Severity
from fullpose_server.session.states import Command, State
from fullpose_server.settings import Settings


@pytest.fixture(scope="module")
def schemas(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Any]:
    folder: Path = tmp_path_factory.mktemp("data")
    found: dict[str, Any] = create_app(Settings(data_dir=folder)).openapi()["components"]["schemas"]
    return found


def test_states_and_severities_are_the_sessions(schemas: dict[str, Any]) -> None:
    assert schemas["State"]["enum"] == [state.value for state in State]
    assert schemas["Severity"]["enum"] == [severity.value for severity in Severity]
    assert schemas["SessionOut"]["properties"]["state"]["$ref"].endswith("/State")


def test_frames_limits_geometries_and_remedies_are_the_librarys(schemas: dict[str, Any]) -> None:
    blocking, remedy = schemas["BlockingOut"]["properties"], schemas["RemedyIn"]["properties"]
    assert blocking["frame"]["enum"] == list(Frame)
    assert blocking["limit"]["enum"] == list(Limit)
    assert remedy["kind"]["enum"] == list(RemedyKind)
    assert schemas["RigOut"]["properties"]["geometry"]["enum"] == list(Geometry)


def test_every_command_has_a_body(schemas: dict[str, Any]) -> None:
    bodies = {schema["properties"]["command"]["const"] for schema in schemas.values() if _is_command(schema)}
    assert bodies == {command.value for command in Command}


def test_telemetry_has_a_column_for_every_field_of_the_sample(schemas: dict[str, Any]) -> None:
    columns = schemas["Telemetry"]["properties"].keys() - {"type", "seq", "server_time", "dropped"}
    assert columns == {"sample_seq" if name == "seq" else name for name in SAMPLE.names or ()}


def test_the_union_of_the_streams_answers_misses_none(schemas: dict[str, Any]) -> None:
    assert set(schemas["StreamMessageOut"]["discriminator"]["mapping"]) == {
        *("hello", "telemetry", "session", "replay", "pong", "stopped", "problem")
    }
    assert set(schemas["StreamMessageIn"]["discriminator"]["mapping"]) == {
        *("subscribe", "ping", "stop", "estop", "seek", "speed", "pause", "play")
    }


def _is_command(schema: dict[str, Any]) -> bool:
    return {"command", "args", "lease"} == set(schema.get("properties", {}))
