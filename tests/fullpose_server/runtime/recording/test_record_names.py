"""The names of records: what has just changed is seen, and what has not is not read again."""

import os
from pathlib import Path

import pytest

from fullpose_server.runtime.recording.record_names import RecordNames


def test_a_change_is_seen_at_once_however_quickly_it_follows(tmp_path: Path) -> None:
    names = RecordNames(tmp_path)
    for number in range(50):
        (tmp_path / f"{number:02}.mcap").touch()
        (tmp_path / f"{number:02}.json").touch()
        assert names.all() == tuple(f"{n:02}" for n in range(number + 1))
    (tmp_path / "07.mcap").unlink()
    assert "07" not in names.all()


def test_a_folder_that_rests_is_read_once(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "one.mcap").touch()
    os.utime(tmp_path, (1.0, 1.0))  # long ago
    names = RecordNames(tmp_path)
    assert names.all() == ("one",)
    monkeypatch.setattr(os, "scandir", lambda _: pytest.fail("read again"))
    assert names.all() == ("one",)
    os.utime(tmp_path, (2.0, 2.0))
    monkeypatch.undo()
    (tmp_path / "two.mcap").touch()
    assert names.all() == ("one", "two")
