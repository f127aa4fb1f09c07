"""Evidence over HTTP: of a run that was flown, verified without the server; and what is refused."""

from pathlib import Path

from fullpose_server.evidence.signing import public_key, signing_key
from fullpose_server.evidence.verification import verify_bundle
from tests.fullpose_server.api.live_server import LiveServer, Operator
from tests.support.waiting import until


def test_of_a_run_that_was_flown(server: LiveServer, run: str, tmp_path: Path) -> None:
    answer = server.http.get(f"/runs/{run}/evidence")
    assert answer.status_code == 200, answer.text
    assert answer.headers["content-type"] == "application/zip"
    assert f'filename="{run}.zip"' in answer.headers["content-disposition"]
    path = tmp_path / "run.zip"
    path.write_bytes(answer.content)
    found = verify_bundle(path, public_key(signing_key(server.settings.data_dir)))
    assert (found.run, found.rig, found.missing, found.trusted) == (run, "vertical-4", {}, True)
    assert len(found.fits) == 4
    assert "every limit of the rig was kept" in found.sentence
    until(lambda: not list((server.settings.data_dir / "uploads").iterdir()))  # it goes once the last byte is sent


def test_what_there_is_none_of(server: LiveServer, run: str) -> None:
    assert server.http.get("/runs/nothing/evidence").status_code == 404
    broken = server.settings.data_dir / "runs" / "broken.mcap"
    broken.write_bytes(b"not a record")
    assert server.http.get("/runs/broken/evidence").status_code in (409, 422)  # it may be one that has just begun
    broken.unlink()
    assert not list((server.settings.data_dir / "uploads").iterdir())


def test_of_a_run_that_is_being_flown(operator: Operator, server: LiveServer) -> None:
    operator.command("load", plan=server.plan()["id"])
    operator.command("arm")
    operator.command("start")
    operator.wait("running")
    operator.command("hold")
    flying = operator.wait("held")["run_id"]
    answer = server.http.get(f"/runs/{flying}/evidence")
    assert (answer.status_code, answer.json()["type"]) == (409, "urn:fullpose:problem:in-use")
    server.http.post("/rigs/vertical-4/stop")
    operator.wait("armed")
