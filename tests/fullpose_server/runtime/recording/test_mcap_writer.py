"""The record of a run, read by the library that Foxglove and Lichtblick read it with."""

import json
import subprocess
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from fullpose_server.runtime.contract.telemetry import SAMPLE, Samples
from fullpose_server.runtime.recording.export import repair
from fullpose_server.runtime.recording.mcap_reader import (
    RecordError,
    is_complete,
    read_events,
    read_samples,
    run_of,
)
from fullpose_server.runtime.recording.mcap_writer import RunRecord
from fullpose_server.session.states import STATES
from tests.build.test_hatch_build import hatch_build
from tests.support.repository import ROOT

WALL_NS = 1_800_000_000_000_000_000
ALARM = {
    "kind": "alarm",
    "time_ns": 1_050_000_000,
    "wall_ns": WALL_NS + 50_000_000,
    "number": 1,
    "code": "guard_rate",
    "severity": "fault",
    "message": "too fast",
    "time_s": WALL_NS / 1e9,
    "frame": "inner",
    "value": 201.5,
    "limit": 200.0,
    "unit": "deg/s",
    "first": True,
    "acknowledged_by": None,
    "count": 1,
}
COMMAND = {
    "kind": "command",
    "time_ns": 1_000_000_000,
    "wall_ns": WALL_NS,
    "who": "somebody",
    "command": "start",
    "args": {"plan": "p"},
    "epoch": 3,
    "before": "armed",
    "after": "positioning",
    "refused": None,
}


def rows() -> Samples:
    """A second of telemetry: first without a target, then with one frame's encoder lost."""
    made = np.zeros(1000, SAMPLE)
    made["seq"] = np.arange(1, 1001)
    made["tick"] = np.arange(1000)
    made["time_ns"] = 1_000_000_000 + 1_000_000 * np.arange(1000)
    made["wall_ns"] = WALL_NS + 1_000_000 * np.arange(1000)
    made["state"] = STATES.index("running")
    rng = np.random.default_rng(5)
    for name in ("demand", "demand_rate", "demand_acceleration", "measured", "measured_rate", "target"):
        made[name] = rng.normal(size=(1000, 4)) * 100.0
    made["solve_error_deg"] = 1e-14
    made["target"][:300] = np.nan
    made["solve_error_deg"][:300] = np.nan
    made["path_time_s"][:300] = np.nan
    made["measured"][700:, 2] = np.nan
    return made


@pytest.fixture(scope="module")
def record(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("record") / "run.mcap"
    made = RunRecord(path, {"run_id": "run", "who": "somebody", "plan": {}}, WALL_NS, 1_000_000_000)
    made.add_event(COMMAND)
    for part in np.split(rows(), 10):
        made.add_samples(part)
        made.cut()
    made.add_event(ALARM)
    lateness = {"p50": 20.0, "p99": 40.0, "p999": 80.0, "max": 90.0}
    statistics = {"ticks": 1000, "deadline_misses": 0, "busy_us": 60.0, "lateness_us": lateness, "free_bytes": 1 << 40}
    made.add_statistics(2_000_000_000, statistics)
    made.finish()
    return path


def read_elsewhere(path: Path, how: str) -> dict[str, Any]:
    console = hatch_build.Console(ROOT)
    node = console.node()
    console.install(node)
    script = (Path(__file__).parent / "read_record.mjs").read_bytes()
    command = [str(node.folder / "node"), "--input-type=module", "-", str(path), how]
    done = subprocess.run(command, cwd=console.sources, input=script, capture_output=True, check=False)
    assert done.returncode == 0, done.stderr.decode()
    found = json.loads(done.stdout)
    assert isinstance(found, dict)
    return found


def check(schema: dict[str, Any], value: Any, where: str) -> None:
    """That both viewers take `schema`, which know one plain type a field, and that `value` is as it says."""
    kinds = {"number": (int, float), "integer": int, "string": str, "boolean": bool}
    if schema["type"] == "object":
        assert isinstance(value, dict), where
        for name, field in schema.get("properties", {}).items():
            if name in value:
                check(field, value[name], f"{where}.{name}")
    elif schema["type"] == "array":
        for item in value:
            if item is not None:  # one frame's encoder may be lost
                check(schema["items"], item, where)
    else:
        assert isinstance(value, kinds[schema["type"]]), (where, value)


@pytest.mark.parametrize("how", ["whole", "cut", "repaired"])
def test_it_is_read_elsewhere_to_the_last_chunk(record: Path, tmp_path: Path, how: str) -> None:
    path = record
    if how != "whole":
        path = tmp_path / "cut.mcap"
        # Before the index, and in the middle of a chunk.
        path.write_bytes(record.read_bytes()[: record.stat().st_size * 6 // 10])
    if how == "repaired":
        whole = tmp_path / "whole.mcap"
        repair(path, whole)
        path = whole
    found = read_elsewhere(path, "cut" if how == "cut" else "whole")
    assert {channel["encoding"] for channel in found["channels"].values()} == {"json"}
    by_id = {channel["id"]: channel for channel in found["channels"].values()}
    for channel in by_id.values():
        assert channel["schemaEncoding"] == "jsonschema"
        assert channel["schemaName"].startswith("fullpose.")
        assert channel["schema"]["type"] == "object"
    for message in found["messages"]:
        channel = by_id[message["channel"]]
        check(channel["schema"], message["content"], channel["schemaName"])
    telemetry = found["channels"]["/telemetry"]["id"]
    samples = [m for m in found["messages"] if m["channel"] == telemetry]
    wanted = rows()[: len(samples)]
    assert len(samples) == 1000 if how == "whole" else 400 <= len(samples) < 1000
    assert [m["sequence"] for m in samples] == wanted["seq"].tolist()
    assert [int(m["logTime"]) for m in samples] == wanted["wall_ns"].tolist()
    assert [m["content"]["demand"] for m in samples] == wanted["demand"].tolist()  # all digits
    assert "target" not in samples[0]["content"]
    if how == "whole":
        assert samples[999]["content"]["measured"][2] is None
        assert {m["content"].get("kind") for m in found["messages"]} == {None, "command", "alarm"}


def test_it_is_read_back_bit_for_bit(record: Path) -> None:
    found = read_samples(record)
    for name in SAMPLE.names or ():
        np.testing.assert_array_equal(found[name], rows()[name], err_msg=name)
    command, alarm = read_events(record)
    assert command == {name: value for name, value in COMMAND.items() if value is not None}
    assert alarm == {name: value for name, value in ALARM.items() if value is not None}


def test_schemas_name_every_field_that_is_written(record: Path) -> None:
    found = read_elsewhere(record, "whole")
    for topic, but in (("/telemetry", set()), ("/events", {"args"}), ("/statistics", set())):
        channel = found["channels"][topic]
        contents = [message["content"] for message in found["messages"] if message["channel"] == channel["id"]]
        assert contents, topic
        assert set().union(*contents) - set(channel["schema"]["properties"]) <= but


def chunk_starts(data: bytes) -> list[int]:
    """Where each chunk's content begins."""
    at, found = 8, []
    while at + 9 < len(data):
        if data[at] == 6:
            found.append(at + 9)
        at += 9 + int.from_bytes(data[at + 1 : at + 9], "little")
    return found


@pytest.mark.parametrize("tail", [b"", bytes(8192), b"\xff" * 8192, bytes(range(1, 256)) * 32])
def test_what_a_power_cut_leaves_is_read_to_the_last_chunk(record: Path, tmp_path: Path, tail: bytes) -> None:
    """The last blocks of the file may hold zeros, or what was on the disk before."""
    data = record.read_bytes()
    starts = chunk_starts(data)
    path, whole = tmp_path / "cut.mcap", tmp_path / "whole.mcap"
    for cut in (starts[6] - 4, starts[6] + 20, starts[6] + 60, (starts[6] + starts[7]) // 2):
        path.write_bytes(data[:cut] + tail)
        np.testing.assert_array_equal(read_samples(path)["seq"], np.arange(1, 601))
        assert [event["kind"] for event in read_events(path)] == ["command"]
        assert run_of(path)["run_id"] == "run"
        assert not is_complete(path)
        repair(path, whole)
        assert is_complete(whole)
        np.testing.assert_array_equal(read_samples(whole)["seq"], np.arange(1, 601))


def test_a_flipped_byte_costs_its_chunk_and_no_wrong_sample_is_read(record: Path, tmp_path: Path) -> None:
    data = record.read_bytes()
    starts = chunk_starts(data)
    assert is_complete(record)
    path = tmp_path / "flipped.mcap"
    sound = rows()
    end = starts[4] + int.from_bytes(data[starts[4] - 8 : starts[4]], "little")
    # What stands before the samples of the fifth chunk (checksum, codec, length), and some of its samples.
    places = [*range(starts[4] + 24, starts[4] + 48), *range(starts[4] + 60, end, 997)]
    for place in places:
        damaged = bytearray(data)
        damaged[place] ^= 0x55
        path.write_bytes(damaged)
        assert not is_complete(path), place
        read = read_samples(path)
        kept = np.r_[0:400, 500:1000]
        for name in SAMPLE.names or ():
            np.testing.assert_array_equal(read[name], sound[name][kept], err_msg=f"{name}, byte {place}")
    repair(path, tmp_path / "whole.mcap")
    assert is_complete(tmp_path / "whole.mcap")


def test_a_length_that_is_damaged_ends_the_file_there(record: Path, tmp_path: Path) -> None:
    data = bytearray(record.read_bytes())
    at = chunk_starts(bytes(data))[4] - 8
    path = tmp_path / "flipped.mcap"
    for byte in range(8):
        damaged = bytearray(data)
        damaged[at + byte] ^= 0xA5
        path.write_bytes(damaged)
        assert not is_complete(path)
        read = read_samples(path)["seq"].tolist()
        assert read[:400] == list(range(1, 401))
        assert read == sorted(set(read) & set(range(1, 1001)))


def test_what_is_no_record_says_why(record: Path, tmp_path: Path) -> None:
    path = tmp_path / "file.mcap"
    data = record.read_bytes()
    for content in (b"", b"not a record", bytes(100_000), data[:8]):
        path.write_bytes(content)
        assert not is_complete(path)
        with pytest.raises(RecordError, match=r"file\.mcap: no"):
            run_of(path)
        with pytest.raises(RecordError, match=r"file\.mcap: not a record"):
            read_samples(path)
        with pytest.raises(RecordError):
            repair(path, tmp_path / "whole.mcap")
        assert not (tmp_path / "whole.mcap").exists()
    path.write_bytes(data[: chunk_starts(data)[0] + 100])  # cut off in its first chunk
    assert run_of(path)["who"] == "somebody"
    assert len(read_samples(path)) == 0
