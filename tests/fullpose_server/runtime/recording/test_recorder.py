"""The recorder on a shared memory that the test fills, a tick a millisecond; and once on a whole rig process."""

import asyncio
import os
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from fullpose_server.runtime.contract.config import GuardConfig, Tolerance
from fullpose_server.runtime.contract.messages import Snapshot
from fullpose_server.runtime.contract.shared_memory import SAMPLES, Shared
from fullpose_server.runtime.contract.telemetry import SAMPLE
from fullpose_server.runtime.recording.mcap_reader import (
    is_complete,
    read_events,
    read_record,
    read_samples,
    run_of,
)
from fullpose_server.runtime.recording.recorder import Recorder
from fullpose_server.session.states import STATES
from tests.fullpose_server.runtime.rigs import config_of, hosted, plan_of, written
from tests.support.waiting import answered, soon

START_NS = 1_000_000_000
OFF = Tolerance(None, None)
# A starved machine is late, and its table lags; what is tested here is the record.
CALM = GuardConfig(following_deg=Tolerance(None, 20.0), attitude_deg=OFF, lateness_ms=OFF, misses_per_s=OFF)


class Rig:
    """What the loop does to the shared memory."""

    def __init__(self, folder: Path) -> None:
        self.shared = Shared(folder / "memory", create=True)
        self.shared.header["period_ns"] = 1_000_000
        self.runs = folder / "runs"
        self.recorder = Recorder(self.shared, self.runs)
        self._row = np.zeros(1, SAMPLE)
        self._now = 0.0

    @property
    def head(self) -> int:
        return self.shared.ring.head

    def tick(self, count: int, rate_deg_s: float = 0.0) -> None:
        for _ in range(count):
            self._row["time_ns"] = self._row["wall_ns"] = START_NS + 1_000_000 * (self.head + 1)
            self._row["measured_rate"] = rate_deg_s
            self.shared.ring.append(self._row)

    def note(self, kind: str, **content: Any) -> None:
        at = START_NS + 1_000_000 * self.head
        self.shared.add_event({"kind": kind, "time_ns": at, "wall_ns": at, "head": self.head, **content})

    def begin(self, name: str, kind: str = "run_begin", **content: Any) -> None:
        self.note(kind, run_id=name, rig="rig", who="ann", plan={}, **content)

    def incident(self, name: str, code: str) -> None:
        self.begin(name, "incident", code=code)
        self.note("alarm", code=code, severity="fault")

    def look(self) -> None:
        self._now += 0.05
        self.recorder.cycle(self._now)

    def record(self, name: str) -> Path:
        return self.runs / f"{name}.mcap"

    def sequences(self, name: str) -> list[int]:
        found: list[int] = read_samples(self.record(name))["seq"].tolist()
        return found


@pytest.fixture
def rig(tmp_path: Path) -> Rig:
    return Rig(tmp_path)


@pytest.mark.parametrize("looks", [True, False])
def test_a_run_that_is_followed_at_once_keeps_its_end(rig: Rig, looks: bool) -> None:
    """Whether the recorder looked in between, or all came in one look."""
    rig.tick(1500)
    ends = {}
    for name in ("a", "b", "c"):
        rig.begin(name)
        rig.tick(700)
        if looks:
            rig.look()
        rig.tick(34)
        rig.note("run_end", run_id=name)
        ends[name] = rig.head
        rig.tick(3)
    rig.look()
    for name, end in ends.items():
        numbers = rig.sequences(name)
        assert numbers == list(range(end - 734 - 999, end + 1)), name
        assert is_complete(rig.record(name))
    assert rig.shared.header["recorder_lost"][0] == 0


def test_one_that_follows_a_killed_one_does_not_say_that_it_records_that_run(rig: Rig) -> None:
    rig.begin("a")
    rig.look()
    assert rig.shared.header["recorder_run"][0] == b"a"
    rig.recorder = Recorder(rig.shared, rig.runs)
    assert rig.shared.header["recorder_run"][0] == b""
    rig.begin("b")
    rig.look()
    assert rig.shared.header["recorder_run"][0] == b"b"


def test_what_was_lost_stays_counted_when_another_run_begins(rig: Rig) -> None:
    rig.begin("a")
    rig.look()
    rig.tick(SAMPLES + 500)
    rig.look()
    lost = int(rig.shared.header["recorder_lost"][0])
    assert lost >= 500
    rig.begin("b")
    rig.look()
    assert rig.shared.header["recorder_lost"][0] == lost


def test_while_nothing_is_recorded_it_is_not_behind(rig: Rig) -> None:
    rig.tick(20_000)
    rig.look()
    assert rig.shared.header["recorder_seq"][0] == rig.head


def test_an_incident_keeps_the_second_before_and_goes_on_until_rest(rig: Rig) -> None:
    rig.tick(3000, rate_deg_s=40.0)
    rig.look()
    rig.incident("x", "following_error")
    rig.tick(1800, rate_deg_s=30.0)
    rig.look()
    rig.tick(50, rate_deg_s=30.0)
    rig.tick(400)
    rig.look()
    numbers = rig.sequences("x")
    assert numbers[0] == 2001
    assert 4851 <= numbers[-1] <= rig.head
    assert np.diff(numbers).tolist() == [1] * (len(numbers) - 1)
    assert [event["kind"] for event in read_events(rig.record("x"))] == ["incident", "alarm"]
    assert is_complete(rig.record("x"))
    run = run_of(rig.record("x"))
    assert (run["incident"], run["rig"], run["who"]) == ("following_error", "rig", "ann")
    before = rig.record("x").stat().st_size
    rig.tick(500)
    rig.look()
    assert rig.record("x").stat().st_size == before


def test_an_incident_at_rest_goes_on_for_a_second_and_one_that_never_rests_ends(rig: Rig) -> None:
    rig.tick(2000)
    rig.incident("x", "estop")
    rig.tick(900)
    rig.look()
    assert not is_complete(rig.record("x"))
    rig.tick(200)
    rig.look()
    assert is_complete(rig.record("x"))
    rig.incident("y", "link_lost")
    begun = rig.head
    for _ in range(3):
        rig.tick(3000, rate_deg_s=float("nan"))
        rig.look()
    assert not is_complete(rig.record("y"))
    rig.tick(1100, rate_deg_s=float("nan"))
    rig.look()
    assert is_complete(rig.record("y"))
    assert rig.sequences("y")[-1] >= begun + 10_000


def test_more_faults_belong_to_the_incident_or_run_that_is_recorded(rig: Rig) -> None:
    rig.tick(2000)
    rig.incident("x", "following_error")
    rig.tick(800)
    rig.look()
    rig.incident("y", "link_lost")
    second = rig.head
    rig.tick(1200)
    rig.look()
    assert is_complete(rig.record("x"))
    rows, events = read_record(rig.record("x"))
    assert rows["seq"][-1] >= second + 1000
    assert [event["code"] for event in events if event["kind"] == "alarm"] == ["following_error", "link_lost"]
    rig.begin("run")
    rig.incident("z", "estop")
    rig.tick(100)
    rig.look()
    assert sorted(path.stem for path in rig.runs.iterdir()) == ["run", "x"]


def test_a_run_ends_an_incident_and_an_incident_may_follow_a_run_at_once(rig: Rig) -> None:
    rig.tick(2000)
    rig.incident("x", "estop")
    rig.tick(300)
    rig.look()
    rig.begin("run")
    rig.tick(40)
    rig.note("run_end", run_id="run")
    rig.incident("y", "estop")
    rig.tick(1100)
    rig.look()
    assert rig.sequences("x") == list(range(1001, 2301))
    assert rig.sequences("run") == list(range(1301, 2341))
    assert rig.sequences("y")[0] == 1341
    assert all(is_complete(rig.record(name)) for name in ("x", "run", "y"))


@pytest.mark.parametrize(
    ("kind", "frame", "code"), [("stuck", "inner", "following_error"), ("link", None, "link_lost")]
)
def test_a_fault_of_a_move_is_kept_though_nothing_flew(tmp_path: Path, kind: str, frame: str | None, code: str) -> None:
    async def move() -> None:
        options = {"faults": [{"kind": kind, "frame": frame, "at_s": 2.0}]}
        config = config_of(tmp_path, drive_options=options, guard=CALM)
        plan = written(tmp_path / "plan", plan_of(config.rig, 1.0))
        async with hosted(config) as (host, operator):
            await operator.arm(plan)

            async def moved_on() -> Snapshot | None:  # to and fro, until it fails
                snapshot = host.snapshot()
                if snapshot.state in ("faulted", "disconnected"):
                    return snapshot
                if snapshot.state == "armed":
                    way = 50.0 if snapshot.pose_deg[3] < 0.0 else -50.0
                    await operator.say("move", target_deg=[0.0, 0.0, 0.0, way])
                await operator.renew()
                return None

            snapshot = await answered(moved_on, every_s=0.01)
            assert code in [alarm.code for alarm in snapshot.alarms]
            await soon(lambda: any(is_complete(path) for path in (tmp_path / "runs").glob("*.mcap")))
        (record,) = (tmp_path / "runs").iterdir()
        assert "-test-incident-" in record.stem
        assert is_complete(record)
        run = run_of(record)
        assert (run["incident"], run["rig"], run["who"]) == (code, "test", "operator")
        rows, events = read_record(record)
        (alarm,) = (event for event in events if event.get("code") == code and event["kind"] == "alarm")
        assert (alarm["first"], alarm.get("frame")) == (True, frame)
        assert STATES.index("positioning") in rows["state"]
        before_s = (alarm["time_ns"] - rows["time_ns"][0]) / 1e9
        after_s = (rows["time_ns"][-1] - alarm["time_ns"]) / 1e9
        assert before_s > 0.9
        assert after_s >= 1.0

    asyncio.run(move())


def test_a_recorder_in_reserve_that_is_never_needed_ends_without_a_word() -> None:
    module = "fullpose_server.runtime.recording.recorder"
    command = [sys.executable, "-m", module, "--parent", str(os.getpid())]
    ended = subprocess.run(command, stdin=subprocess.DEVNULL, capture_output=True, text=True, check=False)
    assert (ended.returncode, ended.stdout, ended.stderr) == (0, "", "")
