"""Stop gates that hang, and all of them gone at once: a rig in flight is stopped all the same, and at once.

FAULT_ROUNDS makes it a campaign: on a machine with nothing else to do every answer comes within a second.
"""

import json
import os
import signal
import time
from pathlib import Path

import httpx
import pytest
from websockets.exceptions import ConnectionClosed

from tests.faults.laboratory import NAME, Laboratory
from tests.support.repository import PYTHONPATH
from tests.support.sockets import connect
from tests.support.waiting import until

CAMPAIGN = "FAULT_ROUNDS" in os.environ
ROUNDS = int(os.environ.get("FAULT_ROUNDS", "1"))
ANSWERED_S = 1.0 if CAMPAIGN else 60.0

# In a gate's process, whose number is in the file: asked for the time its event loop does what the file says.
HANGS = """
import ctypes, os, sys, time
_monotonic, _fault = time.monotonic, os.environ["HANGING_GATE"]
def _asked():
    if "fullpose_server.gate.process" in " ".join(sys.orig_argv) and os.path.exists(_fault):
        pid, how = open(_fault).read().split()
        while int(pid) == os.getpid():
            if how == "sleeps":
                time.sleep(3600.0)
            elif how == "holds":
                ctypes.PyDLL(None).sleep(3600)
    return _monotonic()
time.monotonic = _asked
"""


def estopped(lab: Laboratory) -> float:
    """The flight is E-stopped over HTTP; the time that its answer took [s]."""
    asked = time.monotonic()
    answer = httpx.post(f"http://127.0.0.1:{lab.port}/api/v1/rigs/{NAME}/estop", timeout=60.0)
    took_s = time.monotonic() - asked
    assert answer.status_code == 200
    assert took_s < ANSWERED_S
    return took_s


@pytest.mark.parametrize("how", ["spins", "sleeps", "holds"])
def test_a_gate_whose_event_loop_hangs_is_replaced_before_it_is_missed(tmp_path: Path, how: str) -> None:
    (tmp_path / "site").mkdir()
    (tmp_path / "site" / "sitecustomize.py").write_text(HANGS)
    fault, written = tmp_path / "fault", tmp_path / "written"
    paths = [str(tmp_path / "site"), *filter(None, [os.environ.get("PYTHONPATH")]), PYTHONPATH]
    env = {"PYTHONPATH": os.pathsep.join(paths), "HANGING_GATE": str(fault)}
    with Laboratory(tmp_path / "data", **env) as lab:
        for _ in range(ROUNDS):
            lab.bring("running")
            first, _spare = until(lambda: len(lab.gates()) == 2 and lab.gates())
            written.write_text(f"{first} {how}")
            written.rename(fault)
            time.sleep(0.1)  # until it has asked for the time
            took_s = estopped(lab)
            print(f"{how}: {1e3 * took_s:.0f} ms")
            lab.operator.wait("estopped")
            until(lambda gone=first: gone not in lab.gates())  # type: ignore[misc]
            until(lambda: (lab.healthy() or {}).get("status") == "ok")
            fault.unlink()
        lab.judge({}, None)
        audit = lab.server.http.get("/audit").json()
    assert sum(line["command"] == "estop" for line in audit) == ROUNDS


def test_with_all_gates_gone_at_once_the_server_stands_in(tmp_path: Path) -> None:
    with Laboratory(tmp_path / "data") as lab:
        for _ in range(ROUNDS):
            lab.bring("running")
            both = until(lambda: len(lab.gates()) == 2 and lab.gates())
            for pid in both:
                os.kill(pid, signal.SIGKILL)
            took_s = estopped(lab)
            print(f"both gone: {1e3 * took_s:.0f} ms")
            with connect(f"ws://127.0.0.1:{lab.port}/api/v1/stop") as channel:
                channel.send(json.dumps({"type": "estop", "rig": NAME}))
                assert json.loads(channel.recv(60.0))["done"]["state_after"] == "estopped"
                if not set(both) & set(lab.gates()) and (lab.healthy() or {}).get("status") != "ok":
                    with pytest.raises(ConnectionClosed):  # it is opened anew at the gate that is back
                        channel.recv(60.0)
            until(lambda: (lab.healthy() or {}).get("status") == "ok")
            until(lambda: len(lab.gates()) == 2)
        lab.judge({}, None)


def test_however_often_gates_die_a_stop_is_answered(tmp_path: Path) -> None:
    with Laboratory(tmp_path / "data") as lab:
        lab.bring("idle")
        for _ in range(10 * ROUNDS):
            for pid in lab.gates():
                os.kill(pid, signal.SIGKILL)
            estopped(lab)
        until(lambda: (lab.healthy() or {}).get("status") == "ok")
