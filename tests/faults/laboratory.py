"""A laboratory for faults: a server as a process, one rig in it, an operator, and the records that they leave."""

import contextlib
import os
import signal
import socket
import subprocess
import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Self

import httpx
import numpy as np

from fullpose.rig import Rig
from fullpose_server.formats.rig_file import read_rig
from fullpose_server.runtime.contract.hung import recorder_ended
from fullpose_server.runtime.contract.rig_paths import RigPaths
from fullpose_server.runtime.contract.shared_memory import Shared
from fullpose_server.runtime.contract.telemetry import Flag, Samples
from fullpose_server.runtime.recording.mcap_reader import RecordError, read_samples
from fullpose_server.settings import Settings
from tests.fullpose_server.api.live_server import LiveServer, Operator
from tests.fullpose_server.runtime.rigs import within_limits
from tests.support.serving import start
from tests.support.waiting import until

NAME = "bench"
RATE_HZ = 500.0
FLIGHT = "time_s,yaw_deg,pitch_deg,roll_deg\n" + "".join(
    f"{k / 20},{30 * np.sin(k / 40):.17g},{20 * np.sin(k / 30):.17g},{25 * np.sin(k / 50):.17g}\n" for k in range(401)
)
RIG = f"""\
name = "{NAME}"
geometry = "vertical-4"
[frames.base]
max_rate_deg_s = 200.0
max_acceleration_deg_s2 = 400.0
[frames.outer]
max_rate_deg_s = 200.0
max_acceleration_deg_s2 = 400.0
[frames.middle]
min_deg = -120.0
max_deg = 120.0
max_rate_deg_s = 300.0
max_acceleration_deg_s2 = 800.0
[frames.inner]
min_deg = -100.0
max_deg = 100.0
max_rate_deg_s = 400.0
max_acceleration_deg_s2 = 1500.0
[process]
min_free_mb = 0.0
"""


@dataclass(frozen=True)
class Flown:
    """What `within_limits` asks of whoever flew."""

    rig: Rig
    rate_hz: float


class Laboratory:
    """The server's process on one port and one data folder, started anew as often as it is killed."""

    def __init__(self, data: Path, **env: str) -> None:
        self.data = data
        self.env = {"FULLPOSE_RIG_RATE_HZ": str(RATE_HZ)} | env
        with socket.socket() as free:
            free.bind(("127.0.0.1", 0))
            self.port: int = free.getsockname()[1]
        self.server = LiveServer(self.port, Settings(port=self.port, data_dir=data))
        self.operator = Operator(self.server, NAME)
        self.paths = RigPaths(data / "rigs" / NAME)
        self.rig_file = data / "rigs" / f"{NAME}.toml"
        self.process: subprocess.Popen[str] | None = None
        self.plan = ""

    def __enter__(self) -> Self:
        self.rig_file.parent.mkdir(parents=True, exist_ok=True)
        self.rig_file.write_text(RIG, encoding="utf-8")
        self.flown = Flown(read_rig(self.rig_file).rig, RATE_HZ)
        self.serve()
        return self

    def __exit__(self, *_: object) -> None:
        try:
            with contextlib.suppress(AssertionError, httpx.HTTPError):
                self.to_idle()
        finally:
            if self.process is not None:
                self.process.send_signal(signal.SIGINT)
                self._reaped()
            self.server.http.close()

    def serve(self) -> None:
        """Start the server where none runs, and wait until it answers."""
        if self.process is None or self.process.poll() is not None:
            self._reaped()
            self.process = start("serve", "--port", self.port, "--data-dir", self.data, **self.env)
            assert self.process.stdout is not None
            if not self.process.stdout.readline():
                raise AssertionError(f"the server did not start: {self._said()}")
        until(self.healthy, every_s=0.1)

    def _said(self) -> str:
        """The last of what a server that has ended wrote to stderr."""
        assert self.process is not None
        return self.process.communicate(timeout=60)[1][-2000:]

    def _reaped(self) -> None:
        """Wait for the server's end; what it had started may hold the other ends of its pipes for a while longer."""
        if self.process is not None:
            self.process.wait(timeout=120)
            for pipe in (self.process.stdout, self.process.stderr):
                if pipe is not None:
                    pipe.close()

    def healthy(self) -> dict[str, Any] | None:
        """What health says; None where the server does not answer."""
        with contextlib.suppress(httpx.HTTPError):
            answer = self.server.http.get("/health")
            if answer.status_code == 200:
                return dict(answer.json())
        return None

    def kill_server(self) -> None:
        """As the system does it: at once, without a word."""
        assert self.process is not None
        self.process.kill()
        self.process.wait(timeout=60)

    def gates(self) -> list[int]:
        """The stop gate's process, and the one in reserve: the older first."""
        assert self.process is not None
        children = Path(f"/proc/{self.process.pid}/task/{self.process.pid}/children").read_text("utf-8").split()
        return [int(pid) for pid in children if "gate.process" in Path(f"/proc/{pid}/cmdline").read_text("utf-8")]

    def gate(self) -> int | None:
        """The one that serves; None while there is none."""
        return next(iter(self.gates()), None)

    def shared(self) -> Shared | None:
        """The rig's memory; None where no process runs for it."""
        return None if self.paths.running() is None else Shared(self.paths.memory())

    def planned(self) -> str:
        """A plan that can be flown: made anew where the store has lost the last one, or says that it is damaged."""
        if self.plan:
            kept = self.server.http.get(f"/plans/{self.plan}")
            if kept.status_code == 200 and kept.json().get("flyable"):
                return self.plan
        made = self.server.plan(NAME, method="exact", text=FLIGHT)
        assert made["status"] == "done", made
        self.plan = str(made["id"])
        return self.plan

    def to_idle(self) -> None:
        """The session at rest and reset, whatever was done to it: once its process, if that was killed, is back."""
        until(self._taken, every_s=0.1)
        self.operator.to_idle()

    def _taken(self) -> bool:
        try:
            self.operator.take()
        except httpx.HTTPStatusError as refused:
            if refused.response.status_code != 503:
                raise
            return False
        return True

    def bring(self, state: str) -> None:
        """From wherever the session is to `state`; one that passes by itself may have passed."""
        operator = self.operator
        self.to_idle()
        if state == "idle":
            return
        if state == "estopped":
            self.server.http.post(f"/rigs/{NAME}/estop")
            return
        loaded = operator.command("load", plan=self.planned())
        if loaded.status_code != 200:  # damaged since it was made, and said so: another is made
            self.plan = ""
            loaded = operator.command("load", plan=self.planned())
        assert loaded.status_code == 200, loaded.text
        if state == "ready":
            return
        self._arm()
        if state == "armed":
            return
        operator.command("start")
        if state == "positioning":
            return
        operator.wait("running")
        if state == "held":
            operator.command("hold")
            operator.wait("held")
        elif state == "stopping":
            self.server.http.post(f"/rigs/{NAME}/stop")

    def _arm(self) -> None:
        """Once the disk and the recorder are well."""
        refused = ""

        def armed() -> bool:
            nonlocal refused
            answer = self.operator.command("arm")
            refused = answer.text
            return answer.status_code == 200

        try:
            until(armed, every_s=0.1)
        except AssertionError:
            raise AssertionError(f"never armed: {refused}") from None

    def records(self) -> dict[Path, int]:
        """The runs' files and their sizes."""
        return {path: path.stat().st_size for path in (self.data / "runs").glob("*.mcap")}

    def judge(self, before: dict[Path, int], spoiled: Path | None) -> dict[Path, int]:
        """Every row that was recorded since `before` is inside the limits, none is missing between two.

        Returns the newest sequence in each; `spoiled` is a record that was damaged on purpose.
        """
        until(self._told)
        newest = {}
        for path, size in self.records().items():
            if path == spoiled or before.get(path) == size:
                continue
            try:
                rows = read_samples(path)
            except RecordError:
                assert size < 1024, f"{path} of {size} bytes cannot be read"
                continue
            if len(rows):
                assert (np.diff(rows["seq"].astype(np.int64)) == 1).all(), f"{path}: samples are missing"
                within_limits(rows, self.flown)
                self._inside_ranges(rows)
                newest[path] = int(rows["seq"][-1])
        return newest

    def _told(self) -> bool:
        """Whether the recorder has taken up all that it was told: one that was killed is replaced first."""
        shared = self.shared()
        if shared is None:
            return True
        header = shared.header
        told = int(header["recorder_event"][0]) >= int(header["event_head"][0])
        return told and not recorder_ended(header) and not bytes(header["recorder_run"][0])

    def _inside_ranges(self, rows: Samples) -> None:
        enabled = (rows["flags"] & Flag.ENABLED) != 0
        demand = np.radians(rows["demand"][enabled])
        rig = self.flown.rig
        assert ((demand >= rig.position_min - 1e-9) & (demand <= rig.position_max + 1e-9)).all()


def suspended(pid: int, seconds: float, meanwhile: Callable[[], object] | None = None) -> None:
    """A process that the system does not let run for so long."""
    os.kill(pid, signal.SIGSTOP)
    try:
        if meanwhile is not None:
            meanwhile()
        time.sleep(seconds)
    finally:
        os.kill(pid, signal.SIGCONT)
