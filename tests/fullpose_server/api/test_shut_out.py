"""Who flies and is disabled, or made a viewer, in the middle of it: the rig is held at once, and another flies on."""

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import httpx
import pytest

from fullpose_server.people.roles import Role
from fullpose_server.store.database import Database
from fullpose_server.store.people import PeopleStore
from tests.fullpose_server.api.live_server import FLIGHT, LiveServer, Operator, live_server
from tests.support.waiting import until

RIG = "vertical-4"
PATIENT_S = 300.0


class Person(Operator):
    """An operator who shows a token of their own."""

    def __init__(self, server: LiveServer, secret: str) -> None:
        shown = LiveServer(server.settings.port, server.settings)
        shown.url, shown.ws = server.url, server.ws
        shown.http.close()
        headers = {"Authorization": f"Bearer {secret}"}
        shown.http = httpx.Client(base_url=f"{server.url}/api/v1", timeout=PATIENT_S, headers=headers)
        super().__init__(shown, RIG)
        self.http = shown.http

    def until(self, *states: str) -> dict[str, Any]:
        """Asked again and again until the session is in one of these."""

        def there() -> dict[str, Any] | None:
            session = self.session()
            return session if session["state"] in states else None

        return until(there, every_s=0.05)


@pytest.fixture
def people(tmp_path: Path) -> Iterator[dict[str, Person]]:
    """By name; a server with them is running."""
    database = Database(tmp_path / "fullpose.db")
    store = PeopleStore(database)
    roles = {"ada": Role.ADMIN, "otto": Role.OPERATOR, "olga": Role.OPERATOR}
    secrets = {}
    for name, role in roles.items():
        store.add(name, role, None)
        secrets[name] = store.make_token(name, "a test's", None, None).secret
    with live_server(tmp_path, rig_rate_hz=500.0) as server:
        found = {name: Person(server, secret) for name, secret in secrets.items()}
        yield found
        found["ada"].http.post(f"/rigs/{RIG}/estop")
        for person in found.values():
            person.http.close()
    database.close()


@pytest.mark.parametrize("change", [{"disabled": True}, {"role": "viewer"}])
def test_a_rig_in_flight_is_held_and_flown_on_by_another(people: dict[str, Person], change: dict[str, Any]) -> None:
    ada, otto, olga = people["ada"], people["otto"], people["olga"]
    otto.take("take")
    assert otto.command("connect").is_success
    plan = otto.server.plan(RIG, text=_slow(FLIGHT))
    assert otto.command("load", plan=plan["id"]).is_success
    assert otto.command("arm").is_success
    assert otto.command("start").is_success
    ada.until("running")
    ada.http.put("/users/otto", json=change).raise_for_status()
    refused = otto.command("resume").status_code  # whatever he holds
    assert refused == (401 if "disabled" in change else 403)
    session = ada.until("held")
    assert session["lease"]["holder"] is None
    assert "owner_silent" in {alarm["code"] for alarm in session["alarms"]}
    stops = otto.http.post(f"/rigs/{RIG}/stop").status_code
    assert stops == (401 if "disabled" in change else 200)  # a viewer may stop, who is shut out is nobody
    if stops == 401:
        olga.take("take")
        assert olga.command("resume").is_success
        assert olga.until("running", "armed")["lease"]["holder"] == "olga"
    ada.http.post(f"/rigs/{RIG}/stop")
    ada.until("armed")
    rows = ada.http.get("/audit", params={"rig": RIG}).json()
    assert {"of": "otto"} in [row["args"] for row in rows if row["command"] == "lease lapse"]


def _slow(text: str) -> str:
    """The flight, ten times as long."""
    head, *lines = text.splitlines()
    rows = (line.split(",") for line in lines)
    return "\n".join([head, *(",".join([str(10.0 * float(t)), *angles]) for t, *angles in rows)]) + "\n"
