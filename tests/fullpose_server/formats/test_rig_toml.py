"""A rig as a rig file: read back, it is the same rig."""

import math
from pathlib import Path

import pytest

from fullpose.rig import FrameLimits, Geometry, Rig, builtin_rigs
from fullpose_server.formats.rig_file import read_rig
from fullpose_server.formats.rig_toml import rig_toml

ODD = FrameLimits(-math.radians(1.0 / 3.0), math.radians(719.9), math.inf, math.radians(1e5 / 7.0), 0.1, 1e-3)


@pytest.mark.parametrize("rig", [*builtin_rigs().values(), Rig("odd", Geometry.VERTICAL_4, (ODD,) * 4)], ids=str)
def test_it_is_read_back_to_the_last_bit(rig: Rig, tmp_path: Path) -> None:
    path = tmp_path / "rig.toml"
    path.write_text(rig_toml(rig), encoding="utf-8")
    again = read_rig(path).rig
    assert (again.name, again.geometry) == (rig.name, rig.geometry)
    for index in rig.geometry.frames:
        assert again.frames[index] == rig.frames[index]


def test_numbers_are_those_that_were_meant() -> None:
    text = rig_toml(builtin_rigs()["vertical-limited"])
    assert "max_rate_deg_s = 200.0\n" in text
    assert "[frames.inner]\nmin_deg = -60.0\nmax_deg = 60.0\n" in text
    assert "[frames.base]" not in rig_toml(builtin_rigs()["horizontal-3"])
