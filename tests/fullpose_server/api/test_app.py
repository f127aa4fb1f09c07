"""The app as a whole: foreign pages, unknown paths, the console, the scene, errors nobody planned."""

import asyncio
import json
from pathlib import Path

import httpx
import pytest
from starlette.exceptions import HTTPException
from starlette.responses import Response
from starlette.types import Receive, Scope, Send
from websockets.exceptions import InvalidStatus

from fullpose.registry import method_names
from fullpose_server.api.console import console
from fullpose_server.api.origin import OriginGuard
from fullpose_server.app import create_app
from fullpose_server.settings import Settings, is_loopback
from fullpose_server.wiring import DataDirInUseError
from tests.fullpose_server.api.live_server import LiveServer
from tests.support.sockets import connect


def test_a_foreign_page_may_look_and_not_touch(server: LiveServer) -> None:
    foreign = {"origin": "http://evil.example"}
    answer = server.http.post("/rigs/vertical-4/lease", headers=foreign)
    assert answer.status_code == 403
    assert answer.headers["content-type"] == "application/problem+json"
    assert "evil.example" in answer.json()["detail"]
    assert server.http.get("/rigs", headers=foreign).status_code == 200
    own = {"origin": server.url}
    assert server.http.post("/rigs/nowhere/lease", headers=own).status_code == 404
    for path in ("/api/v1/solve", "/scene/vertical-4/"):
        with pytest.raises(InvalidStatus), connect(f"ws{server.url[4:]}{path}", origin="null"):
            pass


@pytest.mark.parametrize("word", ["stop", "estop"])
def test_no_header_refuses_a_stop(server: LiveServer, word: str) -> None:
    odd = {"origin": "http://evil.example", "host": "rebound.example", "x-fullpose-client": 'joe "b" <' + "x" * 200}
    answer = server.http.post(f"/rigs/vertical-3/{word}", headers=odd)
    assert answer.status_code == 202, answer.text
    line = server.http.get("/audit", params={"rig": "vertical-3", "limit": 1}).json()[0]
    assert (line["command"], line["who"]) == (word, ("joe__b___" + "x" * 200)[:64])


def test_another_name_for_this_server_is_refused(server: LiveServer) -> None:
    assert server.http.get("/rigs", headers={"host": "rebound.example"}).status_code == 403
    assert server.http.get("/rigs", headers={"host": "localhost:1"}).status_code == 200


@pytest.mark.parametrize(
    ("bound", "host", "answered"),
    [
        ("127.0.0.1", "localhost:8642", True),
        ("127.0.0.1", "[::1]:8642", True),
        ("127.0.0.1", "Rig-7.example:8642", True),
        ("127.0.0.1", "192.168.1.5:8642", False),
        ("0.0.0.0", "192.168.1.5:8642", True),
        ("0.0.0.0", "[fe80::1]", True),
        ("0.0.0.0", "rig-7.example", True),
        ("0.0.0.0", "localhost", True),
        ("0.0.0.0", "rebound.example", False),
        ("rig-8.example", "rig-8.example:8642", True),
        ("rig-8.example", "rebound.example", False),
        ("0.0.0.0", "[broken", False),
        ("0.0.0.0", "", False),
    ],
)
def test_an_open_network_does_not_open_every_name(bound: str, host: str, answered: bool) -> None:
    settings = Settings(host=bound, allowed_hosts=("rig-7.example",))

    async def inside(scope: Scope, receive: Receive, send: Send) -> None:
        await Response("inside")(scope, receive, send)

    async def get() -> httpx.Response:
        transport = httpx.ASGITransport(app=OriginGuard(inside, settings))
        async with httpx.AsyncClient(transport=transport, base_url="http://localhost") as client:
            return await client.get("/", headers={"host": host})

    answer = asyncio.run(get())
    assert answer.is_success is answered
    assert answered or "allowed_hosts" in answer.json()["detail"]


def test_paths_that_are_not_there_are_problems(server: LiveServer) -> None:
    for answer in (server.http.get("/nothing"), server.http.delete("/rigs"), server.http.get("/plans/nothing")):
        assert answer.status_code in (404, 405)
        assert answer.headers["content-type"] == "application/problem+json"


def test_rigs_tell_limits_in_degrees(server: LiveServer) -> None:
    rigs = {rig["name"]: rig for rig in server.http.get("/rigs").json()}
    assert set(rigs) == {"vertical-4", "horizontal-4", "vertical-3", "horizontal-3", "vertical-limited"}
    assert rigs["vertical-3"]["frames"]["base"] is None
    inner = rigs["vertical-limited"]["frames"]["inner"]
    assert (inner["min_deg"], inner["max_deg"], inner["max_rate_deg_s"]) == pytest.approx((-60.0, 60.0, 600.0))
    assert rigs["vertical-4"]["frames"]["inner"]["min_deg"] is None


def test_methods_tell_their_options(server: LiveServer) -> None:
    methods = {method["name"]: method for method in server.http.get("/methods").json()}
    assert tuple(methods) == method_names()
    assert methods["plan"]["options"]["stage"] == 0.05


def test_an_infeasible_plan_says_where_and_why(server: LiveServer) -> None:
    fast = "time_s,yaw_deg,pitch_deg,roll_deg\n" + "".join(f"{k / 50},0,0,{k * 30}\n" for k in range(50))
    plan = server.plan(text=fast, method="plan")
    assert (plan["status"], plan["feasible"], plan["flyable"]) == ("done", False, False)
    assert plan["report"]["blocking"] is not None
    assert plan["verdict"].startswith("Infeasible")
    samples = server.http.get(f"/plans/{plan['id']}/samples", params={"points": 100}).json()
    lengths = {len(samples["time_s"]), len(samples["error_deg"]), len(samples["angles_deg"]["base"])}
    assert len(lengths) == 1
    assert max(error for error in samples["error_deg"] if error is not None) > 1.0


def test_what_cannot_be_planned(server: LiveServer) -> None:
    sha256 = server.upload().json()["sha256"]
    good = {"trajectory": sha256, "rig": "vertical-4", "method": "exact"}
    for change, status in (
        ({"trajectory": "0" * 64}, 404),
        ({"trajectory": "zero"}, 422),
        ({"rig": "nowhere"}, 404),
        ({"method": "magic"}, 422),
        ({"options": {"magic": 1}}, 422),
        ({"start_deg": [1.0]}, 422),
    ):
        assert server.http.post("/plans", json=good | change).status_code == status, change


def test_a_rig_file_that_is_none_is_told_and_takes_no_other_rig_down(server: LiveServer) -> None:
    file = server.settings.data_dir / "rigs" / "bad.toml"
    file.write_text('name = "bad"\ngeometry = "vertical-9"\n')
    try:
        health = server.http.get("/health").json()
        assert health["status"] == "degraded"
        (told,) = [word for word in health["warnings"] if "bad.toml" in word]
        assert "geometry" in told
        assert "vertical-4" in [rig["name"] for rig in server.http.get("/rigs").json()]
        assert server.http.get("/rigs/vertical-4/session").status_code == 200
        assert server.http.get("/rigs/bad").status_code == 422
    finally:
        file.unlink()
    assert server.http.get("/rigs/bad").status_code == 404


def test_the_scene_is_served_through_the_same_port(server: LiveServer) -> None:
    page = httpx.get(f"{server.url}/scene/vertical-4/", timeout=60.0)
    assert page.status_code == 200
    assert "<html" in page.text
    assert httpx.get(f"{server.url}/scene/nowhere/").status_code == 404


def test_the_console_answers_for_its_own_routes(tmp_path: Path) -> None:
    (tmp_path / "assets").mkdir()
    (tmp_path / "index.html").write_text("<html>console</html>")
    (tmp_path / "assets" / "a-1234.js").write_text("1")

    async def get(path: str) -> httpx.Response:
        transport = httpx.ASGITransport(app=console(tmp_path))
        async with httpx.AsyncClient(transport=transport, base_url="http://localhost") as client:
            return await client.get(path)

    assert asyncio.run(get("/")).text == asyncio.run(get("/rigs/vertical-4")).text == "<html>console</html>"
    assert asyncio.run(get("/operate/my.rig")).text == "<html>console</html>"
    for missing in ("/gone.js", "/assets/gone", "/api/v1/gone"):
        with pytest.raises(HTTPException, match="404"):
            asyncio.run(get(missing))
    assert "immutable" in asyncio.run(get("/assets/a-1234.js")).headers["cache-control"]


def test_an_error_nobody_planned_is_a_problem_without_its_text(tmp_path: Path) -> None:
    app = create_app(Settings(data_dir=tmp_path))

    async def get() -> httpx.Response:
        # Without the lifespan there are no services, which no handler expects.
        transport = httpx.ASGITransport(app=app, raise_app_exceptions=False)
        async with httpx.AsyncClient(transport=transport, base_url="http://localhost") as client:
            return await client.get("/api/v1/rigs")

    answer = asyncio.run(get())
    assert answer.status_code == 500
    assert answer.headers["content-type"] == "application/problem+json"
    assert "services" not in json.dumps(answer.json())


def test_a_folder_in_use_is_refused(server: LiveServer) -> None:
    app = create_app(Settings(data_dir=server.settings.data_dir))

    async def start() -> None:
        async with app.router.lifespan_context(app):
            pass

    with pytest.raises(DataDirInUseError):
        asyncio.run(start())


@pytest.mark.parametrize(
    ("host", "own"),
    [("localhost", True), ("127.0.0.1", True), ("127.8.8.8", True), ("::1", True), ("[::1]", True), ("0.0.0.0", False),
     ("192.168.1.5", False), ("localhost.evil.example", False), ("", False)],
)  # fmt: skip
def test_what_counts_as_this_machine(host: str, own: bool) -> None:
    assert is_loopback(host) is own


def test_limits_are_the_numbers_that_were_written(server: LiveServer) -> None:
    """They were told as they are kept: 500.00000000000006 deg/s^2."""
    rigs = {rig["name"]: rig for rig in server.http.get("/rigs").json()}
    for rig in rigs.values():
        for frame in filter(None, rig["frames"].values()):
            for key, value in frame.items():
                assert value is None or key == "weight" or value == round(value), (rig["name"], key, value)
    assert rigs["vertical-limited"]["frames"]["inner"]["min_deg"] == -60.0
