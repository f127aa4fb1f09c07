"""What is written: columns, digits, and nothing at all where it goes wrong."""

import csv
import os
import stat
from pathlib import Path

import numpy as np
import pyarrow.parquet as pq
import pytest

from fullpose.attitude import dcm_from_euler
from fullpose.rig import builtin_rigs
from fullpose.solution import Solution
from fullpose.solve import solve
from fullpose_server.errors import FileError
from fullpose_server.formats.output_file import (
    check_apart,
    check_writable,
    replacing,
    write_text,
)
from fullpose_server.formats.solution_file import COLUMNS, write_solution


def solution(n: int = 5000) -> Solution:
    time = np.arange(n) * 1e-3
    attitude = dcm_from_euler(0.3 * np.sin(time), 0.2 * np.sin(2 * time), 0.1 * time)
    return solve(time, attitude, builtin_rigs()["vertical-4"], "exact")


def test_csv_gives_back_every_bit(tmp_path: Path) -> None:
    made = solution()
    calls: list[tuple[int, int]] = []
    write_solution(tmp_path / "out.csv", made, lambda done, total: calls.append((done, total)))
    with (tmp_path / "out.csv").open(newline="") as stream:
        rows = list(csv.reader(stream))
    assert tuple(rows[0]) == COLUMNS
    table = np.array(rows[1:], float)
    np.testing.assert_array_equal(table[:, 0], made.time)
    np.testing.assert_array_equal(table[:, 1:5], np.rad2deg(made.angles))
    np.testing.assert_array_equal(table[:, 5], np.rad2deg(made.error))
    assert {row[6] for row in rows[1:]} == {"0"}
    assert calls[-1] == (5000, 5000)


def test_parquet_has_the_same_columns(tmp_path: Path) -> None:
    made = solution(10)
    write_solution(tmp_path / "out.parquet", made)
    table = pq.read_table(tmp_path / "out.parquet")
    assert tuple(table.column_names) == COLUMNS
    np.testing.assert_array_equal(table.column("inner_deg").to_numpy(), np.rad2deg(made.angles[:, 3]))


def test_an_exception_leaves_the_old_file_and_nothing_beside_it(tmp_path: Path) -> None:
    path = tmp_path / "out.csv"
    path.write_text("old")

    def interrupted() -> None:
        with replacing(path) as draft:
            draft.write_text("half")
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        interrupted()
    assert path.read_text() == "old"
    assert list(tmp_path.iterdir()) == [path]


def test_a_place_that_cannot_be_written_is_known_before_the_work(tmp_path: Path) -> None:
    with pytest.raises(FileError, match="folder"):
        check_writable(tmp_path)
    (tmp_path / "file").write_text("")
    with pytest.raises(FileError, match="place to write"):
        check_writable(tmp_path / "file" / "out.csv")
    with pytest.raises(FileError, match="no folder"):
        check_writable(tmp_path / "new" / "out.csv")
    assert [path.name for path in tmp_path.iterdir()] == ["file"]
    check_writable(tmp_path / "out.csv")


def test_what_is_no_plain_file_is_refused_and_stays(tmp_path: Path) -> None:
    pipe, loop, dash = tmp_path / "pipe", tmp_path / "loop", Path("-")
    os.mkfifo(pipe)
    loop.symlink_to(loop)
    (tmp_path / "link").symlink_to(pipe)
    for path, told in (
        (pipe, "plain file"),
        (tmp_path / "link", "plain file"),
        (loop, "link"),
        (dash, "standard output"),
    ):
        with pytest.raises(FileError, match=told):
            check_writable(path)
        with pytest.raises(FileError, match=told):
            write_text(path, "new")
    assert stat.S_ISFIFO(pipe.stat().st_mode)
    assert sorted(path.name for path in tmp_path.iterdir()) == ["link", "loop", "pipe"]


def test_a_link_stays_and_what_it_leads_to_is_written(tmp_path: Path) -> None:
    folder = tmp_path / "elsewhere"
    folder.mkdir()
    (folder / "old.csv").write_text("old")
    for name in ("old.csv", "new.csv"):
        link = tmp_path / name
        link.symlink_to(folder / name)
        check_writable(link)
        write_text(link, "text")
        assert link.is_symlink()
        assert (folder / name).read_text() == "text"
    assert sorted(path.name for path in folder.iterdir()) == ["new.csv", "old.csv"]


def test_outputs_are_apart_from_inputs_and_from_each_other(tmp_path: Path) -> None:
    flight, link, new = tmp_path / "f.csv", tmp_path / "link.csv", tmp_path / "new.csv"
    flight.write_text("flight")
    link.symlink_to(flight)
    (tmp_path / "dangling.csv").symlink_to(new)
    check_apart({"--out": new, "--report": None, "--plot": tmp_path / "p.html"}, {"IN": flight})
    for out in (flight, link, tmp_path / "." / "f.csv"):
        with pytest.raises(FileError, match="another file for --out, this one is IN"):
            check_apart({"--out": out}, {"IN": flight})
    for report in (new, tmp_path / "dangling.csv"):
        with pytest.raises(FileError, match="another file for --report, this one is --out"):
            check_apart({"--out": new, "--report": report}, {"IN": flight})
