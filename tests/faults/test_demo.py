"""A demo that meets a fault."""

import os
import signal
import time
from pathlib import Path
from typing import Any

import httpx

from fullpose_server.cli.demo import RIG
from tests.support.serving import NO_REAL_TIME, running
from tests.support.waiting import until


def test_a_demo_whose_rig_faults_says_why_and_goes_on_by_itself(tmp_path: Path) -> None:
    with running("demo", "--port", "0", "--data-dir", tmp_path) as (process, url):
        assert process.stdout is not None
        assert "planning" in process.stdout.readline()
        assert "flying" in process.stdout.readline()
        with httpx.Client(base_url=f"{url}/api/v1", timeout=60.0) as http:

            def state() -> str:
                return str(http.get(f"/rigs/{RIG}/session").json()["state"])

            until(lambda: state() == "running")
            rig = http.get("/health").json()["rigs"][RIG]["rig_pid"]
            os.kill(rig, signal.SIGSTOP)
            time.sleep(1.5)  # longer than its drive waits for a word
            os.kill(rig, signal.SIGCONT)
            assert f"{RIG} is faulted: " in process.stdout.readline()
            until(lambda: state() == "running")


def test_a_demo_without_real_time_rights_flies_and_its_health_says_what_is_lost(tmp_path: Path) -> None:
    """What a person on a plain machine has: neither capability nor limit."""
    with running("demo", "--port", "0", "--data-dir", tmp_path, within=NO_REAL_TIME) as (process, url):
        assert process.stdout is not None
        assert "planning" in process.stdout.readline()
        assert "flying" in process.stdout.readline()
        with httpx.Client(base_url=f"{url}/api/v1", timeout=60.0) as http:

            def session() -> dict[str, Any]:
                return dict(http.get(f"/rigs/{RIG}/session").json())

            until(lambda: session()["state"] == "running")
            health = session()["health"]
            told = health["realtime"]
            assert told.startswith("off: SCHED_FIFO refused")
            assert "the loop's profile is lenient: a tick may be 1000 ms late (else 50)" in told

            def counted(**which: str) -> int:
                alarms = session()["history"]
                return sum(a["count"] for a in alarms if all(a[key] == value for key, value in which.items()))

            def stalled() -> bool:
                """Whether the rig flew on; a starved machine may make it later than that, and the demo begins anew."""
                until(lambda: session()["state"] == "running")
                late, faults = counted(code="lateness", severity="warning"), counted(severity="fault")
                os.kill(health["rig_pid"], signal.SIGSTOP)
                time.sleep(0.3)  # a strict profile, or the table's own watchdog, would have braked
                os.kill(health["rig_pid"], signal.SIGCONT)
                until(lambda: counted(code="lateness", severity="warning") > late or counted(severity="fault") > faults)
                return session()["state"] == "running" and counted(severity="fault") == faults

            assert any(stalled() for _ in range(5))
