"""How a rig file says its rig is operated: over the defaults, key by key; what is wrong is named."""

from pathlib import Path

import pytest

from fullpose_server.errors import FileError
from fullpose_server.formats.plan_folder import rig_hash
from fullpose_server.formats.rig_file import RigStore, read_rig
from fullpose_server.operating import GuardConfig, MotionConfig, OperatingConfig, Tolerance
from fullpose_server.session.machine import SilencePolicy

RIG = 'name = "bench"\ngeometry = "vertical-4"\n'
ALL = """
[drive]
name = "acme-t900"
address = "10.0.0.7"
gains = [1.0, 2]
axes = {base = true}
[guard]
following_deg = {warn = 0.5, trip = 2}
attitude_deg = {trip = 4.0}
lateness_ms = {warn = 1.0}
misses_per_s = {}
stale_ms = {warn = 0.0, trip = 0.0}
max_step_deg = 2.5
[motion]
move_rate_deg_s = 30
stop_fraction = 0.5
[silence.owner]
disarm_s = 90.0
[silence.server]
hold_s = 0.5
stop_s = 0.6
disarm_s = 10.0
[process]
realtime_priority = 70
cpu = 1
min_free_mb = 500
"""


def written(folder: Path, text: str) -> Path:
    path = folder / "bench.toml"
    path.write_text(RIG + text, encoding="utf-8")
    return path


def test_every_table_is_read(tmp_path: Path) -> None:
    assert read_rig(written(tmp_path, ALL)).operating == OperatingConfig(
        drive="acme-t900",
        drive_options={"address": "10.0.0.7", "gains": [1.0, 2], "axes": {"base": True}},
        guard=GuardConfig(
            following_deg=Tolerance(0.5, 2.0),
            attitude_deg=Tolerance(None, 4.0),  # a level that is left out is off
            lateness_ms=Tolerance(1.0, None),
            misses_per_s=Tolerance(None, None),
            stale_ms=Tolerance(0.0, 0.0),  # zero is a level
            max_step_deg=2.5,
        ),
        motion=MotionConfig(move_rate_deg_s=30.0, stop_fraction=0.5),
        owner=SilencePolicy(disarm_s=90.0),
        server=SilencePolicy(0.5, 0.6, 10.0),
        realtime_priority=70,
        cpu=1,
        min_free_mb=500.0,
    )


def test_what_a_file_leaves_out_is_as_the_defaults_have_it(tmp_path: Path) -> None:
    assert read_rig(written(tmp_path, "")).operating == OperatingConfig()
    defaults = OperatingConfig(
        guard=GuardConfig(stale_ms=Tolerance(8.0, 40.0)), server=SilencePolicy(2.0, 4.0, 8.0), min_free_mb=7.0
    )
    store = RigStore(tmp_path, defaults)
    assert store.get("vertical-4").operating == defaults
    written(tmp_path, "[guard]\nmax_step_deg = 1.0\n[silence.server]\nstop_s = 3.0\n[process]\ncpu = 0\n")
    assert store.get("bench").operating == OperatingConfig(
        guard=GuardConfig(stale_ms=Tolerance(8.0, 40.0), max_step_deg=1.0),
        server=SilencePolicy(2.0, 3.0, 8.0),
        min_free_mb=7.0,
        cpu=0,
    )


def test_ordinary_scheduling_is_asked_for_by_false(tmp_path: Path) -> None:
    assert read_rig(written(tmp_path, "[process]\nrealtime_priority = false")).operating.realtime_priority is None


def test_plans_stay_good_however_the_rig_is_operated(tmp_path: Path) -> None:
    before = rig_hash(read_rig(written(tmp_path, "")).rig)
    assert rig_hash(read_rig(written(tmp_path, ALL)).rig) == before


@pytest.mark.parametrize(
    ("text", "key", "value", "expected"),
    [
        ("drive = 'udp'", "drive", "'udp'", "table"),
        ("[drive]\nport = 1", "drive.name", "None", "a drive's name"),
        ("[drive]\nname = 7", "drive.name", "7", "a drive's name"),
        ("[drive]\nname = ''", "drive.name", "''", "a drive's name"),
        ("[drive]\nname = 'udp'\nlink_lost_s = inf", "drive.link_lost_s", "inf", "finite"),
        ("[drive]\nname = 'udp'\na = {b = [1979-05-27]}", "drive.a.b", "datetime.date(1979, 5, 27)", "text"),
        ("[drive]\nname = 'udp'\nport = 99999999999999999999", "drive.port", "99999999999999999999", "number"),
        ("[guard]\nspeed = 1", "guard.speed", "'speed'", "following_deg"),
        ("[guard]\nfollowing_deg = 3.0", "guard.following_deg", "3.0", "trip = 3.0"),
        ("[guard]\nfollowing_deg = {alarm = 1}", "guard.following_deg.alarm", "'alarm'", "one of trip, warn"),
        ("[guard]\nfollowing_deg = {warn = -1}", "guard.following_deg.warn", "-1.0", "zero or more"),
        ("[guard]\nfollowing_deg = {trip = nan}", "guard.following_deg.trip", "nan", "a finite number"),
        ("[guard]\nstale_ms = {warn = 2, trip = 1}", "guard.stale_ms.warn", "2.0", "at most trip, which is 1.0"),
        ("[guard]\nstale_ms = {trip = false}", "guard.stale_ms.trip", "False", "a finite number"),
        ("[guard]\nmax_step_deg = -1", "guard.max_step_deg", "-1.0", "zero or more"),
        ("[motion]\nstop = 1", "motion.stop", "'stop'", "stop_fraction"),
        ("[motion]\nstop_fraction = 0", "motion.stop_fraction", "0.0", "above zero"),
        ("[motion]\nhold_scale_rate = '2'", "motion.hold_scale_rate", "'2'", "a finite number"),
        ("[silence]\nhold_s = 1", "silence.hold_s", "'hold_s'", "one of owner, server"),
        ("[silence]\nserver = 1", "silence.server", "1", "a table"),
        ("[silence.server]\nhold = 1", "silence.server.hold", "'hold'", "hold_s"),
        ("[silence.owner]\nhold_s = nan", "silence.owner.hold_s", "nan", "a finite number"),
        (
            "[silence.server]\nhold_s = 9",
            "silence.server",
            "{'hold_s': 9.0, 'stop_s': 5.0, 'disarm_s': 60.0}",
            "0 < hold_s < stop_s < disarm_s",
        ),
        ("[process]\npriority = 1", "process.priority", "'priority'", "realtime_priority"),
        ("[process]\nrealtime_priority = 0", "process.realtime_priority", "0", "1 to 99"),
        ("[process]\nrealtime_priority = true", "process.realtime_priority", "True", "1 to 99"),
        ("[process]\ncpu = 1.5", "process.cpu", "1.5", "a whole number"),
        ("[process]\ncpu = -1", "process.cpu", "-1", "from zero up"),
        ("[process]\nmin_free_mb = nan", "process.min_free_mb", "nan", "a finite number"),
        ("[process]\nmin_free_mb = -1", "process.min_free_mb", "-1.0", "zero or more"),
    ],
)
def test_what_is_wrong_is_named_by_file_key_and_value(
    tmp_path: Path, text: str, key: str, value: str, expected: str
) -> None:
    path = written(tmp_path, text)
    with pytest.raises(FileError) as caught:
        read_rig(path)
    assert (caught.value.file, caught.value.column, caught.value.value) == (str(path), key, value)
    assert expected in caught.value.expected
