"""A server with people: who is let in to what, and what those try who are not."""

import json
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from http.cookies import SimpleCookie
from pathlib import Path
from typing import Any

import httpx
import pytest
from websockets.exceptions import ConnectionClosed, InvalidStatus
from websockets.sync.client import ClientConnection

from fullpose_server.api.access import PUBLIC, needed
from fullpose_server.people.admitted import COOKIE
from fullpose_server.people.roles import Role
from fullpose_server.store.database import Database
from fullpose_server.store.people import PeopleStore
from tests.fullpose_server.api.live_server import LiveServer, live_server
from tests.support.sockets import connect
from tests.support.waiting import until
from tools.roles import TARGET, routes, scope_of, table

PASSWORD = "correct horse battery"
RIG = "vertical-4"
PATIENT_S = 300.0  # a starved machine is long in starting a rig's process


@dataclass
class Laboratory:
    """The server, and a token of each role."""

    server: LiveServer
    people: PeopleStore
    tokens: dict[str, str]

    def client(self, role: str | None) -> httpx.Client:
        """Somebody of that role; None: a stranger."""
        shown = {} if role is None else {"Authorization": f"Bearer {self.tokens[role]}"}
        return httpx.Client(base_url=f"{self.server.url}/api/v1", timeout=PATIENT_S, headers=shown)

    @contextmanager
    def browser(self, name: str) -> Iterator[httpx.Client]:
        """Somebody who signed in with a browser."""
        page = {"Origin": self.server.url}
        with httpx.Client(base_url=f"{self.server.url}/api/v1", timeout=PATIENT_S, headers=page) as client:
            client.post("/login", json={"name": name, "password": PASSWORD}).raise_for_status()
            yield client

    def socket(self, path: str, **headers: str) -> ClientConnection:
        """A WebSocket with these headers."""
        return connect(f"{self.server.ws}{path}", additional_headers=headers)


@pytest.fixture(scope="module")
def lab(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Laboratory]:
    folder = tmp_path_factory.mktemp("data")
    database = Database(folder / "fullpose.db")
    people = PeopleStore(database)
    for role in Role:
        people.add(f"the-{role}", role, PASSWORD)
    tokens = {role.value: people.make_token(f"the-{role}", "a test's", None, None).secret for role in Role}
    with live_server(folder, rig_rate_hz=500.0) as server:
        yield Laboratory(server, people, tokens)
    database.close()


def problem(answer: httpx.Response) -> str:
    """The code of a refusal."""
    code: str = answer.json()["type"]
    return code.removeprefix("urn:fullpose:problem:")


def closed_with(socket: ClientConnection) -> int:
    """The code that the server closes it with."""
    try:
        while True:
            socket.recv(timeout=60.0)
    except ConnectionClosed as closed:
        return 0 if closed.rcvd is None else closed.rcvd.code


def refused_with(lab: Laboratory, path: str, **headers: str) -> int:
    """The status that a WebSocket is refused with before it is accepted; 0: it is accepted."""
    try:
        lab.socket(path, **headers).close()
    except InvalidStatus as refusal:
        return refusal.response.status_code
    return 0


def test_the_committed_table_is_what_is_asked_for() -> None:
    assert TARGET.read_text() == table(), "run python -m tools.roles"


def test_what_nobody_need_sign_in_for_is_listed() -> None:
    asked = {(method, path) for path, method in routes() if needed(scope_of(method, path)) is None}
    assert asked == (PUBLIC & {(method, path) for path, method in routes()}) | {("GET", "/")}


@pytest.mark.parametrize(("path", "method"), [each for each in routes() if each[1] != "WebSocket"])
def test_a_stranger_is_told_nothing_but_to_sign_in(lab: Laboratory, path: str, method: str) -> None:
    scope = scope_of(method, path)
    if needed(scope) is None or method == "HEAD":
        return
    with lab.client(None) as stranger:
        answer = stranger.request(method, f"{lab.server.url}{scope['path']}", content=b"{}")
    assert answer.status_code == 401
    assert problem(answer) == "sign-in"
    assert answer.headers["www-authenticate"].startswith("Bearer")


@pytest.mark.parametrize(("path", "method"), [each for each in routes() if each[1] != "WebSocket"])
@pytest.mark.parametrize("role", list(Role))
def test_a_role_is_refused_what_needs_more(lab: Laboratory, path: str, method: str, role: Role) -> None:
    scope = scope_of(method, path)
    wanted = needed(scope)
    if wanted is None or role.may(wanted):
        return
    with lab.client(role.value) as person:
        answer = person.request(method, f"{lab.server.url}{scope['path']}", content=b"{}")
    assert (answer.status_code, problem(answer)) == (403, "role")


@pytest.mark.parametrize("path", [path for path, method in routes() if method == "WebSocket"])
def test_a_stranger_is_let_in_to_no_socket(lab: Laboratory, path: str) -> None:
    concrete = str(scope_of("WebSocket", path)["path"]).replace("/x/", f"/{RIG}/")
    assert refused_with(lab, f"/../..{concrete}") == 403
    assert refused_with(lab, f"/../..{concrete}", Cookie=f"{COOKIE}=guessed", Origin=lab.server.url) == 403
    assert refused_with(lab, f"/../..{concrete}?token={lab.tokens['admin']}") == 403


def test_a_viewer_watches_and_stops_and_commands_nothing(lab: Laboratory) -> None:
    viewer = {"Authorization": f"Bearer {lab.tokens['viewer']}"}
    assert refused_with(lab, f"/rigs/{RIG}/stream", **viewer) == 0
    assert refused_with(lab, f"/rigs/{RIG}/live", **viewer) == 403
    with lab.client("viewer") as person:
        assert person.get("/rigs").is_success
        assert person.post("/solve", json={}).status_code == 422
        for word in ("stop", "estop"):
            assert person.post(f"/rigs/{RIG}/{word}").status_code == 202
            assert person.post(f"/rigs/{RIG}/commands", json={"command": word}).status_code == 202
        answer = person.post(f"/rigs/{RIG}/commands", json={"command": "connect"})
        assert (answer.status_code, problem(answer)) == (403, "role")
        assert "the-viewer is viewer" in answer.json()["detail"]
    with lab.socket("/stop", **viewer) as channel:
        channel.send(json.dumps({"type": "stop", "rig": RIG, "client": "somebody-else"}))
        assert json.loads(channel.recv())["done"]["unknown"] is not None
    with lab.client("admin") as admin:
        told = [line for line in admin.get("/audit", params={"rig": RIG}).json() if line["command"] == "stop"]
    assert {line["who"] for line in told} == {"the-viewer"}


def test_who_commands_is_who_is_signed_in_whatever_the_header_says(lab: Laboratory) -> None:
    with lab.client("operator") as operator:
        operator.headers["X-Fullpose-Client"] = "the-admin"
        held = operator.post(f"/rigs/{RIG}/lease").raise_for_status().json()
        assert held["holder"] == "the-operator"
        operator.post(f"/rigs/{RIG}/lease", json={"action": "release", "secret": held["secret"]}).raise_for_status()


def test_a_browser_signs_in_and_out(lab: Laboratory) -> None:
    with lab.client(None) as client:
        assert client.get("/me").json() == {"people": True, "person": None, "provider": None}
        answer = client.post("/login", json={"name": "THE-operator", "password": PASSWORD})
        assert answer.json()["person"]["name"] == "the-operator"
        cookie = SimpleCookie(answer.headers["set-cookie"])[COOKIE]
        assert (cookie["httponly"], cookie["samesite"], cookie["path"]) == (True, "strict", "/")
        assert client.get("/me").json()["person"]["via"] == "session"
        assert client.get("/rigs").is_success
        kept = client.cookies[COOKIE]
        assert client.post("/logout", headers={"Origin": lab.server.url}).status_code == 204
        assert client.get("/rigs").status_code == 401
        assert client.get("/rigs", headers={"Cookie": f"{COOKIE}={kept}"}).status_code == 401


def test_the_cookie_is_for_tls_alone_where_a_proxy_speaks_it(lab: Laboratory) -> None:
    with lab.client(None) as client:
        body = {"name": "the-viewer", "password": PASSWORD}
        plain = client.post("/login", json=body)
        secure = client.post("/login", json=body, headers={"X-Forwarded-Proto": "https"})
    assert "Secure" not in plain.headers["set-cookie"]
    assert "Secure" in secure.headers["set-cookie"]


def test_a_session_is_another_one_after_every_sign_in(lab: Laboratory) -> None:
    """Session fixation: what a browser came with is never what it is known by afterwards."""
    with lab.client(None) as client:
        body = {"name": "the-viewer", "password": PASSWORD}
        chosen = {"Cookie": f"{COOKIE}=chosen-by-another"}
        assert "chosen-by-another" not in client.post("/login", json=body, headers=chosen).headers["set-cookie"]
        assert client.get("/rigs", headers=chosen).status_code == 401


@pytest.mark.parametrize("origin", [None, "http://evil.example", "null"])
def test_a_cookie_changes_nothing_for_another_page(lab: Laboratory, origin: str | None) -> None:
    """CSRF: a browser sends its cookie whoever makes it ask."""
    with lab.browser("the-operator") as browser:
        del browser.headers["Origin"]
        headers = {} if origin is None else {"Origin": origin}
        answer = browser.post(f"/rigs/{RIG}/lease", headers=headers)
        assert (answer.status_code, problem(answer)) == (403, "origin")
        cookie = {"Cookie": f"{COOKIE}={browser.cookies[COOKIE]}"}
        assert refused_with(lab, f"/rigs/{RIG}/stream", **cookie, **headers) == 403
        assert refused_with(lab, f"/rigs/{RIG}/stream", **cookie, Origin=lab.server.url) == 0


def test_a_secret_in_an_address_is_none(lab: Laboratory) -> None:
    with lab.client(None) as stranger:
        for name in ("token", "access_token", "authorization", COOKIE):
            assert stranger.get("/rigs", params={name: lab.tokens["admin"]}).status_code == 401


@pytest.mark.parametrize(
    "headers",
    [
        {"Authorization": "Basic dGhlLWFkbWluOmNvcnJlY3QgaG9yc2UgYmF0dGVyeQ=="},
        {"Authorization": "Bearer"},
        {"Authorization": "Bearer " + "x" * 5000},
        {"Authorization": "Bearer fp_\xff\xfe"},
        {"Cookie": f"{COOKIE}"},
        {"Cookie": f'{COOKIE}="; {COOKIE}="'},
        {"X-Forwarded-User": "the-admin", "X-Remote-User": "the-admin", "Remote-User": "the-admin"},
    ],
)
def test_headers_that_are_no_credential_let_nobody_in(lab: Laboratory, headers: dict[str, str]) -> None:
    raw = [(name.encode(), value.encode("latin-1")) for name, value in headers.items()]
    answer = httpx.get(f"{lab.server.url}/api/v1/rigs", headers=raw)
    assert answer.status_code == 401


@pytest.mark.parametrize(
    "path",
    [
        "/api/v1/me/../rigs",
        "/api/v1//rigs",
        "/assets/../api/v1/rigs",
        "/api/v1/login/%2e%2e/rigs",
        "//api/v1/rigs",
        "/%61pi/v1/rigs",
        "/API/v1/rigs",
    ],
)
def test_a_path_written_otherwise_leads_nowhere(lab: Laboratory, path: str) -> None:
    """Path traversal: as the bytes on the wire say, for a client would tidy them."""
    raw = httpx.Request("GET", lab.server.url, extensions={"target": path.encode()})
    with httpx.Client() as client:
        answer = client.send(raw)
    assert answer.status_code in (401, 404) or "<!doctype html>" in answer.text.lower()
    assert "vertical-4" not in answer.text


def test_words_are_tried_only_for_so_long(lab: Laboratory) -> None:
    with lab.client(None) as stranger:
        tries = [stranger.post("/login", json={"name": "the-admin", "password": f"guess number {k}"}) for k in range(7)]
        codes = [answer.status_code for answer in tries]
        assert codes == [401] * 5 + [429] * 2
        assert int(tries[-1].headers["retry-after"]) > 5
        # Not even the right one, which would tell that it is.
        right = stranger.post("/login", json={"name": "the-admin", "password": PASSWORD})
        assert right.status_code == 429
        answers = {json.dumps(answer.json() | {"instance": None}) for answer in tries[:5]}
        nobody = stranger.post("/login", json={"name": "nobody-at-all", "password": PASSWORD})
        assert answers == {json.dumps(nobody.json() | {"instance": None})}


def test_a_refused_body_never_tells_the_password(lab: Laboratory) -> None:
    with lab.client(None) as stranger:
        answer = stranger.post("/login", json={"name": "x", "password": ["hunter two hunter two"]})
    assert answer.status_code == 422
    assert "hunter" not in answer.text


def test_people_are_looked_after_by_admins(lab: Laboratory) -> None:
    with lab.client("admin") as admin:
        made = admin.post("/users", json={"name": "dora", "role": "viewer", "password": PASSWORD})
        assert (made.status_code, made.json()["role"]) == (201, "viewer")
        again = admin.post("/users", json={"name": "Dora", "role": "viewer"})
        assert (again.status_code, problem(again)) == (409, "person")
        short = admin.put("/users/dora", json={"password": "short"})
        assert (short.status_code, problem(short)) == (422, "password")
        last = admin.put("/users/the-admin", json={"role": "viewer"})
        assert (last.status_code, problem(last)) == (409, "person")
        assert admin.put("/users/nobody", json={"role": "viewer"}).status_code == 404
        with lab.browser("dora") as dora:
            assert dora.post(f"/rigs/{RIG}/lease").status_code == 403
            assert admin.put("/users/dora", json={"role": "operator"}).json()["role"] == "operator"
            assert dora.get("/me").json()["person"]["role"] == "operator"
            assert admin.put("/users/dora", json={"disabled": True}).json()["disabled"]
            assert dora.get("/rigs").status_code == 401
            answer = dora.post("/login", json={"name": "dora", "password": PASSWORD})
            assert answer.status_code == 401


def test_an_open_socket_ends_with_its_person(lab: Laboratory) -> None:
    lab.people.add("felix", Role.VIEWER, None)
    given = lab.people.make_token("felix", "a test's", None, None)

    def let_in() -> bool:  # made in another way than through the server, which looks each second
        return refused_with(lab, f"/rigs/{RIG}/stream", Authorization=f"Bearer {given.secret}") == 0

    until(let_in, every_s=0.2)
    paths = (f"/rigs/{RIG}/stream", "/stop", "/solve")
    sockets = [lab.socket(path, Authorization=f"Bearer {given.secret}") for path in paths]
    lab.people.change("felix", disabled=True)
    assert [closed_with(socket) for socket in sockets] == [4401] * 3


def test_one_changes_ones_own_password(lab: Laboratory) -> None:
    lab.people.add("gina", Role.VIEWER, PASSWORD)

    def in_() -> Any:
        with lab.client(None) as client:
            return client.post("/login", json={"name": "gina", "password": PASSWORD}).is_success

    until(in_, every_s=0.2)
    with lab.browser("gina") as gina, lab.browser("gina") as elsewhere:
        wrong = gina.put("/me/password", json={"current": "not it at all", "new": "another long sentence"})
        assert wrong.status_code == 401
        done = gina.put("/me/password", json={"current": PASSWORD, "new": "another long sentence"})
        assert done.status_code == 204
        assert gina.get("/rigs").is_success
        assert elsewhere.get("/rigs").status_code == 401
        token = gina.post("/tokens", json={"label": "a script"}).raise_for_status().json()["id"]
        body = {"current": "another long sentence", "new": "a third long sentence", "revoke_tokens": True}
        assert gina.put("/me/password", json=body).status_code == 204
        assert gina.get("/rigs").is_success
        assert token not in {each["id"] for each in gina.get("/tokens").json()}


@pytest.mark.parametrize("change", [{"disabled": True}, {"role": "viewer"}])
def test_who_may_command_no_longer_loses_the_lease_at_once_and_the_audit_says_so(
    lab: Laboratory, change: dict[str, Any]
) -> None:
    name = f"otto-{next(iter(change))}"
    with lab.client("admin") as admin:
        admin.post("/users", json={"name": name, "role": "operator", "password": PASSWORD}).raise_for_status()
        with lab.browser(name) as otto:
            assert otto.post(f"/rigs/{RIG}/lease").raise_for_status().json()["holder"] == name
        assert (
            admin.get(f"/rigs/{RIG}/session").json()["lease"]["holder"] == name
        )  # signed out or not: it lapses by time
        admin.put(f"/users/{name}", json=change).raise_for_status()
        assert admin.get(f"/rigs/{RIG}/session").json()["lease"]["holder"] is None
        lines = admin.get("/audit", params={"rig": RIG}).json()
    told = next(line for line in lines if line["command"] == "lease lapse")
    assert (told["who"], told["args"], told["accepted"]) == ("(server)", {"of": name}, True)


def test_what_was_typed_for_a_name_and_is_nobodys_is_not_written_down(lab: Laboratory) -> None:
    with lab.client(None) as stranger:
        for name in ("hunter2hunter2", "THE-viewer"):
            assert stranger.post("/login", json={"name": name, "password": "not it at all"}).status_code == 401
    with lab.client("admin") as admin:
        lines = admin.get("/audit").json()
    refused = [line["who"] for line in lines if line["command"] == "login" and not line["accepted"]]
    assert refused[:2] == ["the-viewer", "(unknown name)"]
    assert "hunter2" not in str(lines)


def test_tokens_are_ones_own(lab: Laboratory) -> None:
    with lab.client("operator") as operator, lab.client("viewer") as viewer, lab.client("admin") as admin:
        made = operator.post("/tokens", json={"label": "a script", "role": "viewer", "days": 1})
        assert made.status_code == 201
        token = made.json()
        assert token["secret"].startswith("fp_")
        assert "secret" not in operator.get("/tokens").text
        more = operator.post("/tokens", json={"label": "more", "role": "admin"})
        assert more.status_code == 403
        shown = {"Authorization": f"Bearer {token['secret']}"}
        with httpx.Client(base_url=f"{lab.server.url}/api/v1", headers=shown) as script:
            assert script.get("/me").json()["person"]["role"] == "viewer"
            child = script.post("/tokens", json={"label": "a child"}).json()
            assert child["role"] == "viewer"
            assert viewer.delete(f"/tokens/{token['id']}").status_code == 404
            assert token["id"] in {each["id"] for each in admin.get("/tokens").json()}
            assert admin.delete(f"/tokens/{token['id']}").status_code == 204
            assert script.get("/rigs").status_code == 401


def test_who_did_what_to_whom_is_written_down(lab: Laboratory) -> None:
    with lab.client("admin") as admin:
        lines = admin.get("/audit", params={"limit": 200}).json()
    about = [line for line in lines if line["rig"] is None]
    assert {"login", "user add", "user change", "token create", "token revoke", "password"} <= {
        line["command"] for line in about
    }
    assert all(line["address"] == "127.0.0.1" for line in about)
    assert not any(PASSWORD in json.dumps(line) or "fp_" in json.dumps(line) for line in lines)
    assert any(not line["accepted"] and line["command"] == "login" for line in about)


def test_without_people_nobody_is_asked_and_nobody_is_made(tmp_path: Path) -> None:
    with live_server(tmp_path) as server:
        assert server.http.get("/me").json() == {"people": False, "person": None, "provider": None}
        for path, body in (
            ("/login", {"name": "x", "password": "y"}),
            ("/users", {"name": "x", "role": "admin"}),
            ("/tokens", {"label": "x"}),
        ):
            answer = server.http.post(path, json=body)
            assert (answer.status_code, problem(answer)) == (409, "no-people")
            assert "fullpose user add" in answer.json()["detail"]
        assert not server.http.get("/health").json()["authenticated"]
        begun = time.time()
        database = Database(tmp_path / "fullpose.db")
        PeopleStore(database).add("ann", Role.ADMIN, None)
        database.close()
        until(lambda: server.http.get("/rigs").status_code == 401, every_s=0.1)
        assert time.time() > begun


def test_a_lease_is_its_persons_and_its_secret_is_nobody_elses(lab: Laboratory) -> None:
    other = lab.people.make_token("the-admin", "an admin's", None, None).secret
    with lab.client("operator") as operator, lab.client("admin") as admin:
        held = operator.post(f"/rigs/{RIG}/lease").raise_for_status().json()
        token = {"epoch": held["epoch"], "sequence": 1, "secret": held["secret"]}
        stolen = admin.post(f"/rigs/{RIG}/commands", json={"command": "acknowledge", "lease": token})
        assert (stolen.status_code, problem(stolen)) == (403, "lease-lost")
        for action in ("renew", "release", "grant"):
            answer = admin.post(f"/rigs/{RIG}/lease", json={"action": action, "secret": held["secret"]})
            assert answer.status_code == 403
        done = operator.post(f"/rigs/{RIG}/commands", json={"command": "acknowledge", "lease": token})
        assert done.is_success
        bare = admin.post(f"/rigs/{RIG}/lease", json={"action": "takeover"})
        assert (bare.status_code, problem(bare)) == (422, "reason")
        why = "the operator has left, the hall is to be closed"
        taken = admin.post(f"/rigs/{RIG}/lease", json={"action": "takeover", "reason": why}).raise_for_status().json()
        token |= {"sequence": 2}
        late = operator.post(f"/rigs/{RIG}/commands", json={"command": "acknowledge", "lease": token})
        assert (late.status_code, problem(late)) == (403, "lease-lost")
        lines = admin.get("/audit", params={"rig": RIG}).json()
        assert why in {line["args"].get("reason") for line in lines if line["command"] == "lease takeover"}
        release = {"action": "release", "secret": taken["secret"]}
        with httpx.Client(
            base_url=f"{lab.server.url}/api/v1", headers={"Authorization": f"Bearer {other}"}
        ) as elsewhere:

            def released() -> bool:
                return elsewhere.post(f"/rigs/{RIG}/lease", json=release).is_success

            until(released, every_s=0.1)
