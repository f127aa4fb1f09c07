"""A rig that is operated as its file says: on a table behind the udp drive, by a third party's drive, left alone."""

from pathlib import Path

import numpy as np
import pytest

from fullpose.rig import builtin_rigs
from fullpose_server.drives.base import Status
from fullpose_server.formats.rig_toml import rig_toml
from fullpose_server.operating import GuardConfig, OperatingConfig, Tolerance
from fullpose_server.runtime.contract.config import decode
from fullpose_server.runtime.contract.messages import decode_published
from fullpose_server.runtime.contract.rig_paths import RigPaths
from fullpose_server.runtime.contract.shared_memory import Shared
from fullpose_server.session.machine import SilencePolicy
from tests.fullpose_server.api.live_server import FLIGHT, LiveServer, Operator, live_server
from tests.fullpose_server.drives.tables import emulator
from tests.support.waiting import until

# A starved machine is late, and its table lags: what is tested here is not how much.
PATIENT = """
[guard]
following_deg = {trip = 60.0}
attitude_deg = {}
lateness_ms = {}
misses_per_s = {}
"""
GUARD = GuardConfig(
    following_deg=Tolerance(None, 60.0),
    attitude_deg=Tolerance(None, None),
    lateness_ms=Tolerance(None, None),
    misses_per_s=Tolerance(None, None),
    stale_ms=Tolerance(20.0, 100.0),  # as the live source's settings have it
)
LONG = "time_s,yaw_deg,pitch_deg,roll_deg\n" + "".join(f"{k / 2},{10 * np.sin(k / 20)},0,0\n" for k in range(240))


def rig_file(data: Path, text: str) -> str:
    """Write a rig file with `vertical-4`'s geometry and limits; returns the rig's name."""
    (data / "rigs").mkdir()
    rig = rig_toml(builtin_rigs()["vertical-4"]).replace('name = "vertical-4"', 'name = "bench"')
    (data / "rigs" / "bench.toml").write_text(rig + text, encoding="utf-8")
    return "bench"


def started(server: LiveServer, rig: str, text: str) -> Operator:
    """Connect, load, arm and start a flight; the operator."""
    operator = Operator(server, rig)
    operator.to_idle()
    plan = server.plan(rig, text=text)
    assert plan["flyable"], plan["refusal"]
    for word, args in (("load", {"plan": plan["id"]}), ("arm", {}), ("start", {})):
        answer = operator.command(word, **args)
        assert answer.is_success, answer.text
    return operator


def test_a_flight_on_a_table_behind_the_udp_drive(tmp_path: Path) -> None:
    log = tmp_path / "table.log"
    data = tmp_path / "data"
    data.mkdir()
    with emulator("--log", str(log), "--watchdog", "2.0", "--seconds", "300") as (port, _):
        drive = f"[drive]\nname = 'udp'\nport = {port}\nlink_lost_s = 2.0\n[process]\nmin_free_mb = 1.0\n"
        rig = rig_file(data, PATIENT + drive)
        with live_server(data, rig_rate_hz=500.0) as server:
            operator = started(server, rig, FLIGHT)
            operator.wait("running")
            session = operator.wait("armed", "faulted", "disconnected")
            assert (session["state"], operator.session()["drive"]) == ("armed", "udp"), session["alarms"]
            operator.to_idle()
        told = decode((data / "rigs" / rig / "config.json").read_bytes())
    assert {name: getattr(told, name) for name in OperatingConfig.__dataclass_fields__} == vars(
        OperatingConfig(drive="udp", drive_options={"port": port, "link_lost_s": 2.0}, guard=GUARD, min_free_mb=1.0)
    )
    rows = np.array([[float(n) for n in line.split()] for line in log.read_text().splitlines(keepends=True)[:-1]])
    enabled = (rows[:, 1].astype(int) & Status.ENABLED) != 0
    assert enabled.any()
    assert not enabled[-1]
    # The table itself has moved, as far as the flight goes.
    assert np.ptp(rows[:, 2:6], axis=0).max() > 5.0


ACME = """
from fullpose_server.drives.base import DriveError
from fullpose_server.drives.simulated import SimulatedOptions, SimulatedDrive

def make(rig, rate_hz, options):
    if set(options) - {"address"}:
        raise DriveError("acme drive: expected no option but address")
    drive = SimulatedDrive(rig, rate_hz, SimulatedOptions())
    drive.name = "acme at " + options["address"]
    return drive
"""


@pytest.fixture
def acme(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A third party's package where rig processes find it."""
    site = tmp_path / "site"
    info = site / "acme_fullpose-1.0.dist-info"
    info.mkdir(parents=True)
    (site / "acme_fullpose.py").write_text(ACME)
    (info / "METADATA").write_text("Metadata-Version: 2.1\nName: acme-fullpose\nVersion: 1.0\n")
    (info / "entry_points.txt").write_text("[fullpose.drives]\nacme-t900 = acme_fullpose:make\n")
    monkeypatch.setenv("PYTHONPATH", str(site))


@pytest.mark.usefixtures("acme")
def test_a_drive_of_a_third_party_is_chosen_by_name_and_told_its_options(tmp_path: Path) -> None:
    rig = rig_file(tmp_path, "[drive]\nname = 'acme-t900'\naddress = '10.0.0.7'\n")
    with live_server(tmp_path, rig_rate_hz=500.0) as server:
        operator = Operator(server, rig)
        operator.to_idle()
        assert operator.session()["drive"] == "acme at 10.0.0.7"


@pytest.mark.usefixtures("acme")
@pytest.mark.parametrize(
    ("drive", "told"),
    [
        ("name = 'acme-t900'\nport = 1", "acme drive: expected no option but address"),
        ("name = 'acme-t1000'", "no drive 'acme-t1000': there are acme-t900, simulated, udp"),
        ("name = 'udp'\nprot = 1", "udp drive: no option prot"),
    ],
)
def test_a_drive_that_cannot_be_made_is_said_and_other_rigs_go_on(tmp_path: Path, drive: str, told: str) -> None:
    rig = rig_file(tmp_path, f"[drive]\n{drive}\n")
    with live_server(tmp_path, rig_rate_hz=500.0) as server:
        refused = server.http.post(f"/rigs/{rig}/lease", json={"action": "take"})
        assert refused.status_code == 503
        assert told in refused.json()["detail"]
        assert server.http.post("/rigs/vertical-4/lease", json={"action": "take"}).is_success


def test_a_silent_server_means_hold_stop_and_disarm_when_the_file_says(tmp_path: Path) -> None:
    silence = "[silence.owner]\nhold_s = 100.0\nstop_s = 200.0\ndisarm_s = 300.0\n"
    silence += "[silence.server]\nhold_s = 1.0\nstop_s = 1.5\ndisarm_s = 2.0\n"
    rig = rig_file(tmp_path, PATIENT + silence + "[process]\nmin_free_mb = 1.0\n")
    with live_server(tmp_path, rig_rate_hz=500.0, stop_rigs_on_exit=False) as server:
        started(server, rig, LONG)
    paths = RigPaths(tmp_path / "rigs" / rig)
    assert paths.running() is not None
    assert decode(paths.config.read_bytes()).server == SilencePolicy(1.0, 1.5, 2.0)
    memory = Shared(paths.memory())
    seen = set()

    def disarmed() -> bool:
        data = memory.snapshot()
        assert data is not None
        seen.add(decode_published(data).state)
        return "ready" in seen

    until(disarmed, patience_s=50.0)  # without the file's times it is armed for 60 s
    with live_server(tmp_path, rig_rate_hz=500.0) as server:
        session = Operator(server, rig).session()
        assert session["state"] == "ready"
        codes = {alarm["code"] for alarm in session["alarms"]}
        assert "server_silent" in codes
        assert "owner_silent" not in codes
