"""A demo that meets a fault."""

import os
import signal
import time
from pathlib import Path

import httpx

from tests.support.serving import running
from tests.support.waiting import until


def test_a_demo_whose_rig_faults_says_why_and_goes_on_by_itself(tmp_path: Path) -> None:
    with running("demo", "--port", "0", "--data-dir", tmp_path) as (process, url):
        assert process.stdout is not None
        assert "planning" in process.stdout.readline()
        assert "flying" in process.stdout.readline()
        with httpx.Client(base_url=f"{url}/api/v1", timeout=60.0) as http:

            def state() -> str:
                return str(http.get("/rigs/vertical-4/session").json()["state"])

            until(lambda: state() == "running")
            rig = http.get("/health").json()["rigs"]["vertical-4"]["rig_pid"]
            os.kill(rig, signal.SIGSTOP)
            time.sleep(1.5)  # longer than its drive waits for a word
            os.kill(rig, signal.SIGCONT)
            assert "vertical-4 is faulted: " in process.stdout.readline()
            until(lambda: state() == "running")
