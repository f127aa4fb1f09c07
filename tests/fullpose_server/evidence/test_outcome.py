"""Whether the limits were kept, from rows that the test made."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from fullpose.rig import Rig, builtin_rigs
from fullpose_server.evidence.outcome import outcome_of
from fullpose_server.runtime.contract.telemetry import SAMPLE, Flag, Samples
from fullpose_server.runtime.recording.run_summary import RunSummary, named

RATE_HZ = 500.0


@pytest.fixture
def run(tmp_path: Path) -> RunSummary:
    (tmp_path / "run.mcap").touch()
    return named(tmp_path / "run.mcap")


def rows_of(acceleration_deg_s2: list[float]) -> Samples:
    """The base frame's, of a drive that is enabled."""
    rows = np.zeros(len(acceleration_deg_s2), SAMPLE)
    rows["seq"] = 1 + np.arange(len(rows))
    rows["time_ns"] = (rows["seq"] * 1e9 / RATE_HZ).astype(np.int64)
    rows["flags"] = Flag.ENABLED
    rows["demand_acceleration"][:, 0] = acceleration_deg_s2
    return rows


def jerk_rig(deg_s3: float) -> Rig:
    rig = builtin_rigs()["vertical-4"]
    base, outer, middle, inner = rig.frames
    return replace(rig, frames=(replace(base, max_jerk=np.radians(deg_s3)), outer, middle, inner))


def test_a_jerk_that_was_not_kept_is_told_where_it_was(run: RunSummary) -> None:
    rows = rows_of([0.0, 1.0, 2.0, 2.0, 5.0, 2.0, 2.0])  # 500, 500, 0, 1500, -1500 and 0 deg/s^3
    found = outcome_of(run, rows, jerk_rig(1499.0))
    assert found.limits_kept is False
    [one] = found.exceeded
    assert (one.frame, one.limit, one.samples) == ("base", "max_jerk_deg_s3", 2)
    assert np.isclose(one.value, 1500.0)
    assert np.isclose(one.time_s, 4 / RATE_HZ)
    assert outcome_of(run, rows, jerk_rig(1500.0)).limits_kept is True
    assert outcome_of(run, rows, builtin_rigs()["vertical-4"]).limits_kept is True


def test_no_jerk_is_made_up_where_samples_are_missing_or_the_drive_was_off(run: RunSummary) -> None:
    rows = rows_of([0.0, 0.0, 9.0, 9.0])
    assert outcome_of(run, rows, jerk_rig(1000.0)).limits_kept is False
    lost = rows.copy()
    lost["seq"][2:] += 3
    assert outcome_of(run, lost, jerk_rig(1000.0)).limits_kept is True
    off = rows.copy()
    off["flags"][1] = 0
    assert outcome_of(run, off, jerk_rig(1000.0)).limits_kept is True
