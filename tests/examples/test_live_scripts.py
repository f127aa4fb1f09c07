"""The live examples, run as a person would, into a running server and its rig process."""

import re
import socket
import threading
from collections.abc import Iterator

import pytest

from tests.examples.test_scripts import run
from tests.fullpose_server.api.live_server import LiveServer, Operator, live_server


@pytest.fixture(scope="module")
def port() -> int:
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as free:
        free.bind(("127.0.0.1", 0))
        return int(free.getsockname()[1])


@pytest.fixture(scope="module")
def server(tmp_path_factory: pytest.TempPathFactory, port: int) -> Iterator[LiveServer]:
    # The machine of the tests may starve the sender: bridged longer than on a quiet one.
    patient = {"live_delay_ms": 20.0, "live_extrapolate_ms": 1000.0, "live_udp_ports": {"vertical-4": port}}
    with live_server(tmp_path_factory.mktemp("data"), rig_rate_hz=500.0, **patient) as live:
        yield live


def test_jsbsim_is_followed_exactly(server: LiveServer) -> None:
    said = run("live_jsbsim.py", "--url", server.url, "--seconds", "5")
    found = re.search(r"(\d+) samples answered, (\d+) followed", said)
    assert found is not None, said
    assert int(found[1]) > 500
    assert int(found[2]) > 200
    error = re.search(r"solve error up to (\S+) deg, behind the sample by up to (\S+) deg", said)
    assert error is not None, said
    assert float(error[1]) < 1e-9
    assert float(error[2]) < 5.0
    session = server.http.get("/rigs/vertical-4/session").json()
    assert session["state"] == "idle"
    assert session["lease"]["holder"] is None
    assert [alarm["code"] for alarm in session["history"] if alarm["severity"] != "warning"] == []
    run_ = server.http.get("/runs").json()[0]
    assert run_["who"] == "jsbsim"


def test_the_plain_client_is_answered_and_followed(server: LiveServer, port: int) -> None:
    operator = Operator(server)
    operator.to_idle()
    assert "status 32" in run("udp_client.py", str(port), "1.5")
    key = operator.command("load", live={}).json()["live_key"]
    assert "status 8" in run("udp_client.py", str(port), "1.5", key)
    for command in ("arm", "go_live"):
        assert operator.command(command).is_success
    over = threading.Event()

    def renew() -> None:
        while not over.wait(1.0):
            operator.lease()

    renewing = threading.Thread(target=renew)
    renewing.start()
    try:
        said = run("udp_client.py", str(port), "3.5", key)
    finally:
        over.set()
        renewing.join()
    # On a starved machine a second of it may be limited: what is said is followed in another.
    assert re.search(r"[2-6] s  status 1  angles", said), said
    operator.wait("armed")
    operator.to_idle()
