"""Rig files: what DESIGN allows is read, what is wrong is named by key."""

import math
from pathlib import Path

import pytest

from fullpose.rig import Geometry, builtin_rigs
from fullpose_server.errors import FileError, NotFoundError
from fullpose_server.formats.rig_file import Payload, RigStore, find_rig, read_rig

FULL = """
name = "bench-3"
geometry = "vertical-4"
[frames.base]
min_deg = -170.0
max_deg = 170.0
max_rate_deg_s = 200.0
max_acceleration_deg_s2 = 500.0
weight = 2.0
home_deg = 10.0
[payload]
size_m = [0.3, 0.2, 0.1]
"""


def written(folder: Path, text: str) -> Path:
    path = folder / "bench-3.toml"
    path.write_text(text, encoding="utf-8")
    return path


def test_every_key_is_read_in_degrees(tmp_path: Path) -> None:
    entry = read_rig(written(tmp_path, FULL))
    base = entry.rig.frames[0]
    assert entry.rig.name == "bench-3"
    assert [base.min, base.max, base.max_rate, base.max_acceleration, base.home] == [
        math.radians(v) for v in (-170, 170, 200, 500, 10)
    ]
    assert base.weight == 2.0
    assert entry.payload == Payload((0.3, 0.2, 0.1), None)


def test_no_key_no_limit(tmp_path: Path) -> None:
    entry = read_rig(written(tmp_path, 'name = "bench-3"\ngeometry = "horizontal-3"\n'))
    assert entry.rig.geometry is Geometry.HORIZONTAL_3
    assert all(frame.continuous and math.isinf(frame.max_rate) for frame in entry.rig.frames)


@pytest.mark.parametrize(
    ("text", "key"),
    [
        ('geometry = "vertical-4"', "name"),
        ('name = "a"', "geometry"),
        ('name = "a"\ngeometry = "vertical-5"', "geometry"),
        ('name = "a"\ngeometry = "vertical-4"\nspeed = 1', "speed"),
        ('name = "a"\ngeometry = "vertical-4"\n[frames.base]\nmax_rate = 1', "frames.base.max_rate"),
        ('name = "a"\ngeometry = "vertical-3"\n[frames.base]\nmax_deg = 1', "frames.base"),
        ('name = "a"\ngeometry = "vertical-4"\n[frames.base]\nmin_deg = 1', "frames.base.min_deg"),
        ('name = "a"\ngeometry = "vertical-4"\n[frames.base]\nmax_rate_deg_s = 0', "frames.base.max_rate_deg_s"),
        ('name = "a"\ngeometry = "vertical-4"\n[frames.base]\nmax_jerk_deg_s3 = 0', "frames.base.max_jerk_deg_s3"),
        ('name = "a"\ngeometry = "vertical-4"\n[frames.base]\nmax_jerk_deg_s3 = -1', "frames.base.max_jerk_deg_s3"),
        ('name = "a"\ngeometry = "vertical-4"\n[frames.base]\nmax_rate_deg_s = "5"', "frames.base.max_rate_deg_s"),
        ('name = "a"\ngeometry = "vertical-4"\n[frames.base]\nmax_rate_deg_s = nan', "frames.base.max_rate_deg_s"),
        ('name = "a"\ngeometry = "vertical-4"\n[payload]\nsize_m = [1, 2]', "payload.size_m"),
        ('name = "a"\ngeometry = "vertical-4"\n[payload]\nsize_m = [1, 2, -1]', "payload.size_m"),
    ],
)
def test_what_is_wrong_is_named_by_key(tmp_path: Path, text: str, key: str) -> None:
    with pytest.raises(FileError) as caught:
        read_rig(written(tmp_path, text))
    assert caught.value.column == key
    assert f"key {key}" in str(caught.value)


@pytest.mark.parametrize(
    ("keys", "told"),
    [
        ("max_deg = 60", r"max_deg: 60: expected min_deg beside it \(a single stop: give the other one as far as"),
        ("min_deg = -60", r"min_deg: -60: expected max_deg beside it"),
        ("min_deg = 60\nmax_deg = 50", r"max_deg: 50: expected at least min_deg, 60"),
        ("min_deg = 20\nmax_deg = 60", r"home_deg: 0.0: expected a position inside the range, 20 to 60 deg"),
        ("min_deg = -20\nmax_deg = 60\nhome_deg = 70", r"home_deg: 70: expected a position inside the range, -20 to"),
        ("max_acceleration_deg_s2 = -1", r"max_acceleration_deg_s2: -1: expected a number above zero"),
    ],
)
def test_what_is_wrong_with_a_frame_is_told_in_degrees(tmp_path: Path, keys: str, told: str) -> None:
    with pytest.raises(FileError, match=r"key frames\.inner\." + told):
        read_rig(written(tmp_path, f'name = "a"\ngeometry = "vertical-4"\n[frames.inner]\n{keys}'))


def test_text_that_is_no_toml_names_the_line(tmp_path: Path) -> None:
    with pytest.raises(FileError, match="line 2"):
        read_rig(written(tmp_path, 'name = "a"\ngeometry = vertical-4\n'))


def test_rigs_are_found_by_name_and_by_path(tmp_path: Path) -> None:
    path = written(tmp_path, FULL)
    assert find_rig("vertical-limited").builtin
    assert find_rig(str(path)).rig.name == "bench-3"
    with pytest.raises(NotFoundError, match="vertical-limited"):
        find_rig("nowhere")


def test_the_store_adds_files_to_the_built_in_rigs(tmp_path: Path) -> None:
    store = RigStore(tmp_path)
    assert [entry.rig.name for entry in store.all()] == list(builtin_rigs())
    written(tmp_path, FULL)
    assert store.get("bench-3").rig.frames[0].weight == 2.0


def test_a_file_that_is_no_rig_costs_the_others_nothing(tmp_path: Path) -> None:
    store = RigStore(tmp_path)
    written(tmp_path, FULL)
    (tmp_path / "other.toml").write_text(FULL, encoding="utf-8")
    assert [entry.rig.name for entry in store.all()] == [*builtin_rigs(), "bench-3"]
    assert store.get("bench-3").rig.name == "bench-3"
    assert store.get("vertical-4").builtin
    (told,) = store.broken()
    assert "other.toml" in str(told)
    with pytest.raises(FileError, match="other"):
        store.get("other")
