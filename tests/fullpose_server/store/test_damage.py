"""Files cut off and bits turned over, at any place: one clear error each, nothing deleted, and the server starts."""

import contextlib
import json
import os
import shutil
import sqlite3
from pathlib import Path
from typing import Any

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from fullpose_server.errors import DamagedError, StorageError
from fullpose_server.formats.plan_folder import PlanFolderError, read_plan
from fullpose_server.planning.comparisons import Comparisons
from fullpose_server.store.database import Database, NewerDatabaseError
from fullpose_server.store.quarantine import Quarantine
from tests.fullpose_server.api.live_server import LiveServer, live_server
from tests.support.waiting import until

FEW = settings(max_examples=60, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])


def damaged(data: bytes, place: float, how: str) -> bytes:
    """`data` cut off at that place of it, with a bit turned over there, or with a block of zeros from there on."""
    at = min(int(place * len(data)), len(data) - 1)
    match how:
        case "cut":
            return data[:at]
        case "bit":
            return data[:at] + bytes([data[at] ^ 0x10]) + data[at + 1 :]
        case _:
            return data[:at] + bytes(len(data[at : at + 512])) + data[at + 512 :]


HOWS = st.sampled_from(["cut", "bit", "zeros"])
PLACES = st.floats(0.0, 1.0)


@pytest.fixture(scope="module")
def whole(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A data folder with a flight, a plan and a comparison in it; its server has ended."""
    folder = tmp_path_factory.mktemp("whole")
    with live_server(folder, rig_rate_hz=500.0) as server:
        plan = server.plan()
        body = {"trajectory": plan["trajectory"], "rig": "vertical-4", "methods": ["exact"]}
        made = server.http.post("/compare", json=body).json()
        while made["status"] in ("queued", "running"):
            made = server.http.get(f"/compare/{made['id']}").json()
    return folder


@FEW
@given(place=PLACES, how=HOWS)
def test_a_database_is_whole_or_known_to_be_damaged(whole: Path, tmp_path: Path, place: float, how: str) -> None:
    path = tmp_path / "fullpose.db"
    path.write_bytes(damaged((whole / "fullpose.db").read_bytes(), place, how))
    for end in ("-wal", "-shm"):
        path.with_name(path.name + end).unlink(missing_ok=True)
    with contextlib.suppress(DamagedError, NewerDatabaseError, StorageError):
        Database(path).close()


@FEW
@given(place=PLACES, how=HOWS, name=st.sampled_from(["plan.json", "angles.npy", "target.npy", "error.npy"]))
def test_a_plan_is_whole_or_known_to_be_damaged(whole: Path, tmp_path: Path, place: float, how: str, name: str) -> None:
    (source,) = (folder for folder in (whole / "plans").iterdir() if folder.is_dir())
    folder = tmp_path / "plan"
    shutil.rmtree(folder, ignore_errors=True)
    shutil.copytree(source, folder)
    (folder / name).write_bytes(damaged((source / name).read_bytes(), place, how))
    with contextlib.suppress(PlanFolderError):
        read_plan(folder)


@FEW
@given(place=PLACES, how=HOWS, name=st.sampled_from(["request.json", "report.json"]))
def test_a_comparison_is_whole_or_in_quarantine(whole: Path, tmp_path: Path, place: float, how: str, name: str) -> None:
    (source,) = (whole / "comparisons").iterdir()
    root, quarantine = tmp_path / "comparisons", Quarantine(tmp_path / "quarantine")
    for folder in (root, quarantine.folder):
        shutil.rmtree(folder, ignore_errors=True)
    shutil.copytree(source, root / source.name)
    (root / source.name / name).write_bytes(damaged((source / name).read_bytes(), place, how))
    for job in Comparisons(root, quarantine).all():
        with contextlib.suppress(DamagedError):
            Comparisons(root, quarantine).report(job.id)
    assert (root / source.name).is_dir() or len(quarantine.findings()) == 1


def test_a_newer_database_is_told_in_one_line(tmp_path: Path) -> None:
    path = tmp_path / "fullpose.db"
    Database(path).close()
    with contextlib.closing(sqlite3.connect(path)) as connection, connection:
        connection.execute("UPDATE alembic_version SET version_num = '9999'")
    with pytest.raises(NewerDatabaseError, match="revision 9999") as newer:
        Database(path)
    assert "\n" not in str(newer.value)


def findings(server: LiveServer) -> list[str]:
    health = server.http.get("/health").json()
    assert health["status"] == "degraded"
    return list(health["warnings"])


def test_a_server_starts_on_damaged_files_of_every_kind_and_names_each(whole: Path, tmp_path: Path) -> None:
    folder = tmp_path / "data"
    shutil.copytree(whole, folder)
    (folder / "fullpose.db").write_bytes(b"\0" * 5000)
    (comparison,) = (folder / "comparisons").iterdir()
    (comparison / "request.json").write_bytes(b'{"rig"')
    (folder / "rigs" / "mine.toml").write_bytes(b"")
    (folder / "runs" / "20260101T000000-mine-000001.mcap").write_bytes(b"\0" * 1000)
    os.utime(folder / "runs" / "20260101T000000-mine-000001.mcap", (1.0, 1.0))
    with live_server(folder, rig_rate_hz=500.0) as server:
        found = findings(server)
        for kind in ("database", "comparison", "rig mine"):
            assert any(told.startswith(kind) and "quarantine" in told for told in found), (kind, found)
        _await(server, "run 20260101T000000-mine-000001 is damaged")
        assert server.upload().status_code == 201
        assert server.plan()["status"] == "done"
    kept = [path.name for path in (folder / "quarantine").rglob("*") if path.is_file()]
    assert {"fullpose.db", "request.json", "mine.toml", "20260101T000000-mine-000001.mcap"} <= set(kept)


def test_damaged_arrays_are_named_and_can_be_made_again(whole: Path, tmp_path: Path) -> None:
    folder = tmp_path / "data"
    shutil.copytree(whole, folder)
    (plan,) = (one for one in (folder / "plans").iterdir() if one.is_dir())
    (flight,) = (one for one in (folder / "trajectories").iterdir() if one.is_dir())
    (plan / "angles.npy").write_bytes((plan / "angles.npy").read_bytes()[:200])
    (flight / "q.npy").write_bytes(b"")
    with live_server(folder, rig_rate_hz=500.0) as server:
        _await(server, f"plan {plan.name} is damaged")
        _await(server, f"flight {flight.name[:16]} is damaged")
        row = server.http.get(f"/plans/{plan.name}").json()
        assert (row["status"], row["error"]["code"], row["flyable"]) == ("failed", "damaged", False)
        preview = server.http.get(f"/trajectories/{flight.name}/preview")
        assert (preview.status_code, preview.json()["type"]) == (409, "urn:fullpose:problem:damaged")
        assert server.upload().status_code == 200
        assert server.http.get(f"/trajectories/{flight.name}/preview").status_code == 200
        assert server.plan()["status"] == "done"


def _await(server: LiveServer, told: str) -> None:
    until(lambda: any(told in one for one in findings(server)), every_s=0.1)


def test_an_entry_says_what_it_was_and_why(tmp_path: Path) -> None:
    quarantine = Quarantine(tmp_path / "quarantine")
    lost = tmp_path / "a.json"
    lost.write_text(json.dumps({"a": 1}))
    quarantine.take("plan", "a", [lost, tmp_path / "not there"], "no reason")
    (told,) = quarantine.findings()
    assert told.startswith("plan a is damaged (no reason): it is in ")
    (entry,) = quarantine.folder.iterdir()
    kept: dict[str, Any] = json.loads((entry / "a.json").read_text())
    assert kept == {"a": 1}
    assert not lost.exists()
