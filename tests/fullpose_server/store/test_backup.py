"""A data folder as one file and back: nothing lost, nothing changed unseen, nothing written elsewhere."""

import io
import json
import shutil
import tarfile
from pathlib import Path

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from fullpose_server.errors import FileError, ServerError
from fullpose_server.people.roles import Role
from fullpose_server.store.backup import BackupError, make_backup
from fullpose_server.store.database import Database
from fullpose_server.store.people import PeopleStore
from fullpose_server.store.restore import check_backup, restore_backup

LEFT_BEHIND = ("server.lock", "uploads/half", "quarantine/old/x", "rigs/bench/control.sock.note")


def data_folder(folder: Path) -> Path:
    """Small, with something of every kind."""
    database = Database(folder / "fullpose.db")
    PeopleStore(database).add("ann", Role.ADMIN, None)
    database.close()
    kept = ("plans/p1/plan.json", "plans/p1/angles.npy", "trajectories/f1/source.csv", "runs/r1.mcap", "runs/r1.json")
    for number, name in enumerate((*kept, "comparisons/c.json", "rigs/bench.toml", "evidence.key", *LEFT_BEHIND)):
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(f"{name} ".encode() * (number * 50 + 1))
    return folder


def contents(folder: Path) -> dict[str, bytes]:
    """Every file by its path, the database left out."""
    files = (path for path in folder.rglob("*") if path.is_file() and path.name != "fullpose.db")
    return {path.relative_to(folder).as_posix(): path.read_bytes() for path in files}


@pytest.fixture(scope="module")
def original(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return data_folder(tmp_path_factory.mktemp("data"))


@pytest.fixture(scope="module")
def backup(original: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    file = tmp_path_factory.mktemp("backup") / "b.tar"
    make_backup(original, file)
    return file


def test_what_is_restored_is_what_was_there(original: Path, backup: Path, tmp_path: Path) -> None:
    done = restore_backup(backup, tmp_path / "new")
    wanted = {name: data for name, data in contents(original).items() if name not in LEFT_BEHIND}
    assert contents(tmp_path / "new") == wanted
    assert {member.name for member in done.files} == {*wanted, "fullpose.db"}
    database = Database(tmp_path / "new" / "fullpose.db")
    assert [row.name for row in PeopleStore(database).all()] == ["ann"]
    database.close()
    for name in ("fullpose.db", "evidence.key"):
        assert (tmp_path / "new" / name).stat().st_mode & 0o077 == 0
    assert backup.stat().st_mode & 0o077 == 0
    assert not list(original.glob(".backup-*"))


def test_a_database_that_is_open_and_written_is_copied_as_of_one_moment(tmp_path: Path) -> None:
    folder = data_folder(tmp_path / "data")
    database = Database(folder / "fullpose.db")
    people = PeopleStore(database)
    people.add("bob", Role.VIEWER, None)  # in the log beside the file
    make_backup(folder, tmp_path / "b.tar")
    people.add("carl", Role.VIEWER, None)
    database.close()
    restore_backup(tmp_path / "b.tar", tmp_path / "new")
    assert not list((tmp_path / "new").glob("fullpose.db-*"))
    restored = Database(tmp_path / "new" / "fullpose.db")
    assert [row.name for row in PeopleStore(restored).all()] == ["ann", "bob"]
    restored.close()


def test_a_backup_leaves_no_trace_in_a_database_that_nobody_has_open(original: Path, tmp_path: Path) -> None:
    before = sorted(path.name for path in original.iterdir())
    make_backup(original, tmp_path / "b.tar")
    assert sorted(path.name for path in original.iterdir()) == before


def test_what_goes_or_changes_meanwhile_is_in_it_as_it_was(tmp_path: Path) -> None:
    folder = data_folder(tmp_path / "data")
    before = contents(folder)

    def meanwhile(_done: int, _total: int) -> None:
        shutil.rmtree(folder / "plans", ignore_errors=True)
        replaced = folder / "runs" / "new"
        replaced.write_bytes(b"another summary")
        replaced.replace(folder / "runs" / "r1.json")
        with (folder / "runs" / "r1.mcap").open("ab") as record:
            record.write(b"more of it")

    make_backup(folder, tmp_path / "b.tar", meanwhile)
    restore_backup(tmp_path / "b.tar", tmp_path / "new")
    assert contents(tmp_path / "new") == {name: data for name, data in before.items() if name not in LEFT_BEHIND}


@settings(suppress_health_check=[HealthCheck.function_scoped_fixture], deadline=None, max_examples=150)
@given(st.data())
def test_a_bit_that_is_flipped_is_found_or_says_nothing(backup: Path, tmp_path: Path, data: st.DataObject) -> None:
    raw = bytearray(backup.read_bytes())
    raw[data.draw(st.integers(0, len(raw) - 1))] ^= 1 << data.draw(st.integers(0, 7))
    spoilt, target = tmp_path / "spoilt.tar", tmp_path / "spoilt"
    spoilt.write_bytes(raw)
    try:
        restore_backup(spoilt, target)
    except ServerError:
        assert not target.exists()
    else:  # in what fills a block up, or a time that nobody reads
        restore_backup(backup, tmp_path / "whole")
        assert contents(target) == contents(tmp_path / "whole")
        assert (target / "fullpose.db").read_bytes() == (tmp_path / "whole" / "fullpose.db").read_bytes()
        shutil.rmtree(target)
        shutil.rmtree(tmp_path / "whole")


@settings(suppress_health_check=[HealthCheck.function_scoped_fixture], deadline=None, max_examples=40)
@given(st.data())
def test_one_that_was_cut_off_is_found(backup: Path, tmp_path: Path, data: st.DataObject) -> None:
    raw = backup.read_bytes()
    last = len(raw.rstrip(b"\0"))  # a tar ends in empty blocks
    spoilt = tmp_path / "spoilt.tar"
    spoilt.write_bytes(raw[: data.draw(st.integers(0, last - 1))])
    with pytest.raises(ServerError):
        check_backup(spoilt)


def made_up(file: Path, names: list[str], told: list[str] | None = None) -> Path:
    """A tar of these names whose manifest fits, but for what it tells instead."""
    import hashlib

    content = b"content"
    files = [
        {"name": name, "size": len(content), "sha256": hashlib.sha256(content).hexdigest()} for name in (told or names)
    ]
    manifest = json.dumps({"format": 1, "made": 0.0, "version": "0", "revision": "0001", "files": files}).encode()
    with tarfile.open(file, "w") as archive:
        for name, data in [("manifest.json", manifest), *((name, content) for name in names)]:
            entry = tarfile.TarInfo(name)
            entry.size = len(data)
            archive.addfile(entry, io.BytesIO(data))
    return file


@pytest.mark.parametrize(
    "names",
    [
        ["../outside"],
        ["/etc/outside"],
        ["plans/../../outside"],
        ["runs"],
        ["server.lock"],
        ["elsewhere/file"],
        ["plans/a", "plans/a"],
    ],
)
def test_files_of_another_place_are_not_written(tmp_path: Path, names: list[str]) -> None:
    file = made_up(tmp_path / "b.tar", names)
    with pytest.raises((ServerError, OSError)):
        restore_backup(file, tmp_path / "in" / "new")
    assert not list((tmp_path / "in").iterdir())
    assert not (tmp_path / "outside").exists()


def test_files_more_or_less_or_otherwise_are_found(tmp_path: Path) -> None:
    for names, told in (
        (["plans/a", "plans/b"], ["plans/a"]),
        (["plans/a"], ["plans/a", "plans/b"]),
        (["plans/b", "plans/a"], ["plans/a", "plans/b"]),
    ):
        with pytest.raises(FileError):
            check_backup(made_up(tmp_path / "b.tar", names, told))


def test_what_is_no_backup_is_said(tmp_path: Path, original: Path, backup: Path) -> None:
    text = tmp_path / "text.tar"
    text.write_text("no tar")
    for file in (text, tmp_path / "nowhere.tar"):
        with pytest.raises(FileError, match="backup"):
            check_backup(file)
    with pytest.raises(BackupError, match="data folder"):
        make_backup(tmp_path, tmp_path / "b.tar")
    with pytest.raises(BackupError, match="empty or not there"):
        restore_backup(backup, original)
    newer = made_up(tmp_path / "newer.tar", ["plans/a"])
    newer.write_bytes(newer.read_bytes().replace(b'"revision": "0001"', b'"revision": "9001"'))
    with pytest.raises(BackupError, match="newer"):
        check_backup(newer)
