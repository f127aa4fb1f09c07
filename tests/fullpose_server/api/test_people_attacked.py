"""What those tried at a server with people who may not, and what they found."""

import asyncio
import json
from pathlib import Path

import httpx
import pytest
from websockets.exceptions import ConnectionClosed

from fullpose_server.api import admission
from fullpose_server.people.roles import Role
from fullpose_server.store.database import Database
from fullpose_server.store.people import PeopleStore
from tests.fullpose_server.api.live_server import live_server
from tests.fullpose_server.api.test_people import (  # noqa: F401  # the fixture, by its name
    PASSWORD,
    RIG,
    Laboratory,
    closed_with,
    lab,
    problem,
    refused_with,
)
from tests.support.waiting import until


def on_the_wire(client: httpx.Client, method: str, target: str, **body: object) -> httpx.Response:
    """A request for a path as it is written: a client would tidy it."""
    extensions = {"target": f"/api/v1{target}".encode()}
    request = httpx.Request(method, client.base_url, headers=client.headers, json=body, extensions=extensions)
    return client.send(request)


def test_a_line_feed_after_a_path_makes_nobody_an_admin(lab: Laboratory) -> None:  # noqa: F811
    for role in ("viewer", "operator"):
        with lab.client(role) as person:
            listed = on_the_wire(person, "GET", "/users%0A")
            assert (listed.status_code, problem(listed)) == (403, "role")
            made = on_the_wire(person, "POST", "/users%0A", name="evil", role="admin")
            assert (made.status_code, problem(made)) == (403, "role")
    assert lab.people.get("evil") is None
    bearer = {"Authorization": f"Bearer {lab.tokens['viewer']}"}
    assert refused_with(lab, f"/rigs/{RIG}/live%0A", **bearer) == 403


def test_an_origin_that_is_none_is_refused_in_words(lab: Laboratory) -> None:  # noqa: F811
    with lab.client("operator") as operator:
        answer = operator.post(f"/rigs/{RIG}/lease", headers={"Origin": "http://[::1"})
    assert (answer.status_code, problem(answer)) == (403, "origin")


def test_a_stop_on_the_stream_is_its_persons_whatever_it_says(lab: Laboratory) -> None:  # noqa: F811
    bearer = {"Authorization": f"Bearer {lab.tokens['viewer']}"}
    with lab.socket(f"/rigs/{RIG}/stream", **bearer) as stream:
        stream.send(json.dumps({"type": "estop", "client": "the-admin"}))
        while json.loads(stream.recv())["type"] != "stopped":
            pass
    with lab.client("admin") as admin:
        lines = admin.get("/audit", params={"rig": RIG, "limit": 1}).json()
    assert [(line["command"], line["who"]) for line in lines] == [("estop", "the-viewer")]


def test_a_change_of_a_person_is_made_whole_or_not_at_all(lab: Laboratory) -> None:  # noqa: F811
    lab.people.add("hugo", Role.VIEWER, PASSWORD)
    with lab.client("admin") as admin:
        answer = admin.put("/users/hugo", json={"role": "operator", "disabled": True, "password": "short"})
    assert (answer.status_code, problem(answer)) == (422, "password")
    row = lab.people.get("hugo")
    assert row is not None
    assert (row.role, row.disabled) == ("viewer", False)


def test_a_lowered_operators_live_source_ends_though_it_reads_nothing(lab: Laboratory) -> None:  # noqa: F811
    lab.people.add("ida", Role.OPERATOR, None)
    secret = lab.people.make_token("ida", "a test's", None, None).secret
    bearer = {"Authorization": f"Bearer {secret}"}
    until(lambda: refused_with(lab, f"/rigs/{RIG}/stream", **bearer) == 0, every_s=0.2)
    live, stream = lab.socket(f"/rigs/{RIG}/live", **bearer), lab.socket(f"/rigs/{RIG}/stream", **bearer)
    with lab.client("admin") as admin:
        admin.put("/users/ida", json={"role": "viewer"}).raise_for_status()
    assert closed_with(live) == 4401
    stream.send(json.dumps({"type": "ping", "t": 1.0}))  # a viewer watches on
    try:
        while json.loads(stream.recv(timeout=60.0))["type"] != "pong":
            pass
    except ConnectionClosed as closed:
        raise AssertionError("a viewer may watch") from closed
    stream.close()


def test_a_token_makes_none_that_outlives_it(lab: Laboratory) -> None:  # noqa: F811
    with lab.client("operator") as operator:
        day = operator.post("/tokens", json={"label": "for a day", "days": 1}).json()
    bearer = {"Authorization": f"Bearer {day['secret']}"}
    with httpx.Client(base_url=f"{lab.server.url}/api/v1", headers=bearer) as script:
        for days in (None, 300.0, 0.5):
            made = script.post("/tokens", json={"label": "a child", "days": days}).json()
            assert made["until"] is not None
            assert made["until"][:18] <= day["until"][:18]


@pytest.mark.parametrize("name", ["Ärger", "Żółw"])
def test_a_name_in_any_letters_is_one_persons(lab: Laboratory, name: str) -> None:  # noqa: F811
    with lab.client("admin") as admin:
        assert admin.post("/users", json={"name": name, "role": "viewer"}).status_code == 201
        again = admin.post("/users", json={"name": name.swapcase(), "role": "viewer"})
        assert (again.status_code, problem(again)) == (409, "person")
        assert admin.put(f"/users/{name.lower()}", json={"disabled": True}).json()["name"] == name


def test_a_label_is_one_line(lab: Laboratory) -> None:  # noqa: F811
    with lab.client("viewer") as viewer:
        answer = viewer.post("/tokens", json={"label": "two\nlines \x1b[31m"})
    assert (answer.status_code, problem(answer)) == (409, "person")


def test_a_damaged_database_of_people_lets_nobody_in_but_to_stop(tmp_path: Path) -> None:
    database = Database(tmp_path / "fullpose.db")
    PeopleStore(database).add("ann", Role.ADMIN, PASSWORD)
    database.close()
    whole = (tmp_path / "fullpose.db").read_bytes()
    (tmp_path / "fullpose.db").write_bytes(b"damaged!" * 64 + whole[512:])
    for _ in range(2):  # and a start later too
        with live_server(tmp_path) as server:
            assert server.http.get("/me").json()["people"]
            assert server.http.get("/rigs").status_code == 401
            assert server.http.post(f"/rigs/{RIG}/lease").status_code == 401
            assert server.http.get("/alive").json()["status"] == "degraded"
    with live_server(tmp_path) as server:
        again = Database(tmp_path / "fullpose.db")
        people = PeopleStore(again)
        people.add("bob", Role.ADMIN, PASSWORD)
        again.close()
        bob = {"name": "bob", "password": PASSWORD}
        until(lambda: server.http.post("/login", json=bob).is_success, every_s=0.2)


def test_a_flood_of_sign_ins_keeps_nobody_waiting_behind_it(lab: Laboratory) -> None:  # noqa: F811
    async def flood() -> list[httpx.Response]:
        limits = httpx.Limits(max_connections=80)
        async with httpx.AsyncClient(base_url=f"{lab.server.url}/api/v1", timeout=120.0, limits=limits) as stranger:
            tries = (
                stranger.post(
                    "/login",
                    json={"name": f"name{k}", "password": "a guess of many"},
                    headers={"X-Forwarded-For": f"10.0.{k}.1"},
                )
                for k in range(80)
            )
            return await asyncio.gather(*tries)

    answers = asyncio.run(flood())
    assert {answer.status_code for answer in answers} == {401, 429}
    turned_away = [answer for answer in answers if answer.status_code == 429]
    assert {answer.headers["retry-after"] for answer in turned_away} == {"2"}


def test_a_socket_that_reads_nothing_ends_all_the_same(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(admission, "_END_S", 0.01)
    taken = asyncio.Event()

    async def never(_message: object) -> None:
        await asyncio.Event().wait()

    async def served() -> None:
        try:
            await asyncio.Event().wait()
        finally:
            taken.set()

    async def ended() -> None:
        gone = asyncio.Event()
        gone.set()
        async with asyncio.timeout(60.0):
            await admission._until(gone, served(), admission._Ending(never))

    asyncio.run(ended())
    assert taken.is_set()
