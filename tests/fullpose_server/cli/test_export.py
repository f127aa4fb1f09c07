"""`fullpose export` of records that are whole, cut off, and none."""

from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

from fullpose_server.cli import build
from fullpose_server.runtime.contract.telemetry import SAMPLE
from fullpose_server.runtime.recording.mcap_reader import is_complete, read_samples
from fullpose_server.runtime.recording.mcap_writer import RunRecord


@pytest.fixture
def record(tmp_path: Path) -> Path:
    (tmp_path / "runs").mkdir()
    path = tmp_path / "runs" / "20261122T030405-vertical-4-000001.mcap"
    made = RunRecord(path, {"run_id": path.stem, "who": "ann", "plan": {}}, 10**18, 0)
    rows = np.zeros(1000, SAMPLE)
    rows["seq"] = np.arange(1, 1001)
    for part in np.split(rows, 10):
        made.add_samples(part)
        made.cut()
    made.finish()
    return path


def test_mcap_is_whole_whatever_the_record_is(record: Path, tmp_path: Path) -> None:
    out = tmp_path / "out.mcap"
    arguments = ["export", record.stem, "--data-dir", str(tmp_path), "--out", str(out)]
    assert CliRunner().invoke(build(), arguments).exit_code == 0
    assert out.read_bytes() == record.read_bytes()
    record.write_bytes(record.read_bytes()[: record.stat().st_size // 2] + bytes(4096))
    done = CliRunner().invoke(build(), arguments)
    assert done.exit_code == 0, done.output
    assert is_complete(out)
    kept = read_samples(out)["seq"]
    assert 0 < len(kept) < 1000
    np.testing.assert_array_equal(kept, read_samples(record)["seq"])
