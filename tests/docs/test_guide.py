"""What the guide says, against what is there."""

import importlib.util
import re
from pathlib import Path

import pytest

from fullpose.methods import METHODS
from fullpose.registry import method_names
from fullpose.rig import FRAMES, Geometry, builtin_rigs
from fullpose_server.formats.choose_map import OWN
from fullpose_server.formats.profile import shipped
from fullpose_server.formats.rig_file import read_rig
from fullpose_server.formats.rig_operating import PROCESS, TOLERANCES
from fullpose_server.formats.trajectory import Convention
from fullpose_server.operating import (
    OWNER_SILENCE,
    SERVER_SILENCE,
    GuardConfig,
    MotionConfig,
    OperatingConfig,
    Tolerance,
)
from fullpose_server.runtime.loop.loop_profile import LENIENT, STRICT
from fullpose_server.session.machine import SilencePolicy
from fullpose_server.settings import Settings
from tests.support.repository import ROOT

GUIDE = ROOT / "docs" / "guide"
PAGES = sorted([*(ROOT / "docs").rglob("*.md"), *ROOT.glob("*.md"), *(ROOT / "examples").rglob("*.md")])


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_links_and_paths_lead_somewhere(page: Path) -> None:
    text = page.read_text()
    for target in re.findall(r"\]\(([^)#]+)\)", text):
        if not target.startswith("https://"):
            assert (page.parent / target).exists(), target
    for path in re.findall(r"`((?:examples|docker|tools|docs|server|solver|bench|tests|web/src)/[\w./]+)`", text):
        assert (ROOT / path).exists(), path
    for module in re.findall(r"python -m ((?:bench|tools|fullpose_server)[\w.]*)", text):
        assert importlib.util.find_spec(module) is not None, module


def test_index_has_every_page() -> None:
    linked = set(re.findall(r"\]\((\w+\.md)\)", (GUIDE / "index.md").read_text()))
    assert linked >= {page.name for page in GUIDE.glob("*.md")} - {"index.md"}


def test_rig_file_of_the_guide_is_read_as_told(tmp_path: Path) -> None:
    block = re.search(r"```toml\n(.*?)```", (GUIDE / "rigs.md").read_text(), re.DOTALL)
    assert block is not None
    path = tmp_path / "bench.toml"
    path.write_text(block[1])
    entry = read_rig(path)
    assert entry.rig.name == "bench-3"
    assert entry.rig.geometry == Geometry.VERTICAL_4
    assert entry.payload.size_m == (0.3, 0.2, 0.2)


def test_how_the_rig_of_the_guide_is_operated_is_read_as_told(tmp_path: Path) -> None:
    block = re.findall(r"```toml\n(.*?)```", (GUIDE / "rigs.md").read_text(), re.DOTALL)[1]
    path = tmp_path / "bench.toml"
    path.write_text(block)
    assert read_rig(path).operating == OperatingConfig(
        drive="udp",
        drive_options={"host": "10.0.0.7", "port": 7450},
        guard=GuardConfig(following_deg=Tolerance(0.5, 2.0), attitude_deg=Tolerance(None, 5.0)),
        motion=MotionConfig(move_rate_deg_s=30.0),
        server=SilencePolicy(1.0, 1.1, 60.0),
        cpu=3,
    )


def test_rigs_page_has_every_key_of_how_a_rig_is_operated_and_its_default() -> None:
    text = (GUIDE / "rigs.md").read_text()
    rows = [
        [cell.strip(" `") for cell in line.split("|")[1:-1]] for line in text.splitlines() if line.startswith("| `")
    ]
    told = {row[0]: row[1:] for row in rows}
    for name in TOLERANCES:
        level = getattr(GuardConfig(), name) or getattr(STRICT, name)
        assert told[name][:2] == [str(level.warn), str(level.trip)], name
    late, misses = LENIENT.lateness_ms, LENIENT.misses_per_s
    lenient = f"`lateness_ms` {late.warn:g} and {late.trip:g}, `misses_per_s` {misses.warn:g} and off"
    assert lenient in " ".join(text.split())
    assert misses.trip is None
    assert f"`watchdog_s` {LENIENT.watchdog_s}" in text
    defaults = {f"motion.{name}": value for name, value in vars(MotionConfig()).items()}
    defaults |= {f"process.{name}": getattr(OperatingConfig(), name) for name in PROCESS}
    defaults |= {"guard.max_step_deg": GuardConfig().max_step_deg}
    for name, value in defaults.items():
        assert told[name][0] == ("none" if value is None else str(value)), name
    for name, policy in (("[silence.owner]", OWNER_SILENCE), ("[silence.server]", SERVER_SILENCE)):
        assert told[name][:3] == [str(policy.hold_s), str(policy.stop_s), str(policy.disarm_s)], name


def test_rigs_page_has_the_built_in_limits_and_geometries() -> None:
    text = (GUIDE / "rigs.md").read_text()
    letters = "xyz"
    for geometry in Geometry:
        row = next(line for line in text.splitlines() if line.startswith(f"| `{geometry}` |"))
        cells = [cell.strip()[:1] for cell in row.split("|")[2:6]]
        assert cells == [letters[axis] if axis >= 0 else "" for axis in geometry.axes]
    rig = builtin_rigs()["vertical-4"]
    for words, limits in (("rate, deg/s", rig.max_rate), ("acceleration, deg/s^2", rig.max_acceleration)):
        row = next(line for line in text.splitlines() if line.startswith(f"| {words} |"))
        assert [float(cell) for cell in row.split("|")[2:6]] == pytest.approx([x * 57.29577951308232 for x in limits])
    for name in builtin_rigs():
        assert f"`{name}`" in text


def test_methods_table_is_the_registry() -> None:
    text = (GUIDE / "solver.md").read_text()
    rows = dict(re.findall(r"^\| `(\w+)` \|.*\| (yes|no) \|$", text, re.MULTILINE))
    assert set(rows) == set(method_names())
    for name, method in METHODS.items():
        assert rows[name] == ("yes" if method.claims_limits else "no"), name


def test_formats_name_every_column() -> None:
    text = (GUIDE / "formats.md").read_text()
    for convention in Convention:
        assert f"| `{convention}`" in text
    for own in OWN:
        assert ", ".join(spellings[0] for spellings in shipped()[own].wanted[1:]) in text
    for frame in FRAMES:
        assert f"{frame}_deg" in text


def test_settings_table_is_the_settings() -> None:
    text = (GUIDE / "deployment.md").read_text()
    table = set(re.findall(r"`(FULLPOSE_[A-Z_]+)`", text))
    assert {f"FULLPOSE_{name.upper()}" for name in Settings.model_fields} == table
