"""Which records go, and which stay whatever their age."""

import os
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from fullpose_server.errors import NotFoundError
from fullpose_server.runtime.recording.retention import DAY_S, Kept, Retention, sweep
from fullpose_server.runtime.recording.run_index import RunFiles, RunInUseError

NOW = 1_000_000_000.0
RECORDS = st.lists(
    st.tuples(st.integers(0, 1000), st.floats(0.0, 100.0), st.booleans()).map(
        lambda made: (made[0], NOW - made[1] * DAY_S, made[2])
    ),
    max_size=30,
).map(lambda made: [Kept(f"run-{k}", *one) for k, one in enumerate(made)])


@given(records=RECORDS, days=st.none() | st.floats(0.1, 100.0), most=st.none() | st.integers(1, 20_000))
def test_what_goes_is_what_the_rule_says(records: list[Kept], days: float | None, most: int | None) -> None:
    rule = Retention(days, most)
    gone = set(rule.to_remove(records, NOW))
    stay = [record for record in records if record.id not in gone]
    assert all(record.id not in gone for record in records if record.pinned)
    if not rule.on:
        assert not gone
    if days is not None:
        assert all(NOW - record.written <= days * DAY_S for record in stay if not record.pinned)
    if most is not None:
        assert sum(record.bytes for record in stay) <= most or all(record.pinned for record in stay)
    if days is None and gone:  # the oldest went first, and no more of them than had to
        last = max((record for record in records if record.id in gone), key=lambda record: record.written)
        assert sum(record.bytes for record in stay) + last.bytes > (most or 0)


def record(folder: Path, run: str, days: float) -> Path:
    path = folder / f"{run}.mcap"
    path.write_bytes(b"x" * 100)
    path.with_suffix(".json").write_text("{}")
    os.utime(path, (NOW - days * DAY_S,) * 2)
    return path


def test_the_sweep_removes_records_and_what_is_beside_them(tmp_path: Path) -> None:
    runs = RunFiles(tmp_path)
    for k, days in enumerate((1.0, 20.0, 30.0)):
        record(tmp_path, f"2026-rig-{k}", days)
    runs.pin("2026-rig-2", pinned=True)
    assert sweep(runs, Retention(10.0, None), lambda: NOW) == ["2026-rig-1"]
    assert sorted(path.name for path in tmp_path.iterdir()) == [
        "2026-rig-0.json",
        "2026-rig-0.mcap",
        "2026-rig-2.json",
        "2026-rig-2.mcap",
        "2026-rig-2.pin",
    ]
    assert sweep(runs, Retention(None, 100), lambda: NOW) == ["2026-rig-0"]


def test_a_pinned_record_and_one_that_is_written_stay(tmp_path: Path) -> None:
    runs = RunFiles(tmp_path)
    record(tmp_path, "old", 3.0)
    runs.pin("old", pinned=True)
    with pytest.raises(RunInUseError, match="pinned"):
        runs.remove("old")
    runs.pin("old", pinned=False)
    runs.remove("old")
    (tmp_path / "new.mcap").write_bytes(b"\x89MCAP0\r\n")
    with pytest.raises(RunInUseError, match="being written"):
        runs.remove("new")


@pytest.mark.parametrize("run", ["", "..", "../x", "a/b", "x" * 5000, "a\0b", ".hidden"])
def test_an_id_that_is_no_file_s_name_is_no_run(tmp_path: Path, run: str) -> None:
    runs = RunFiles(tmp_path)
    for ask in (runs.path, runs.get, runs.remove, lambda name: runs.pin(name, pinned=True)):
        with pytest.raises(NotFoundError):
            ask(run)
