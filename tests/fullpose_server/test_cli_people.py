"""`fullpose user` and `fullpose token`, as a person types them, and what a server makes of it."""

import json
from pathlib import Path

import httpx
import pytest

from tests.support.command_line import typed
from tests.support.serving import running
from tests.support.waiting import until

PASSWORD = "correct horse battery"
PATIENT_S = 300.0


@pytest.mark.parametrize("address", ["0.0.0.0", "::"])
def test_the_network_is_for_those_who_sign_in(tmp_path: Path, address: str) -> None:
    refused = typed("serve", "--host", address, "--port", "0", "--data-dir", tmp_path)
    assert (refused.returncode, refused.stderr.count("\n")) == (2, 1)
    assert "no users are configured" in refused.stderr
    assert "fullpose user add" in refused.stderr


def test_people_are_made_listed_and_shut_out(tmp_path: Path) -> None:
    there = ("--data-dir", tmp_path)
    assert "no users" in typed("user", "list", *there).stdout
    stdin = typed("user", "add", "ann", "--role", "admin", *there)
    assert (stdin.returncode, stdin.stderr.count("\n")) == (2, 1)
    assert "--password-stdin" in stdin.stderr
    made = typed("user", "add", "ann", "--role", "admin", "--password-stdin", *there, given=f"{PASSWORD}\n")
    assert (made.returncode, made.stdout) == (0, "ann is admin\n")
    for wrong, told in (
        (("user", "add", "Ann", "--role", "admin", "--no-password"), "already"),
        (("user", "add", "bob", "--role", "king", "--no-password"), "expected viewer, operator, admin"),
        (("user", "add", "bob b", "--role", "viewer", "--no-password"), "expected up to 64"),
        (("user", "disable", "ann"), "last admin"),
        (("user", "role", "nobody", "--role", "viewer"), "nobody"),
        (("token", "create", "nobody"), "nobody"),
        (("token", "revoke", "nothing"), "nothing"),
    ):
        refused = typed(*wrong, *there)
        assert (refused.returncode, refused.stderr.count("\n")) == (2, 1), wrong
        assert told in refused.stderr
    token = typed("token", "create", "ann", "--label", "a script", "--role", "viewer", *there).stdout.strip()
    assert token.startswith("fp_")
    assert "a script" in typed("token", "list", *there).stdout
    lines = [json.loads(line) for line in typed("audit", "list", *there).stdout.splitlines()]
    assert [line["command"] for line in lines] == ["user add", "token create"]
    assert {line["who"].partition(" (")[2] for line in lines} == {"command line)"}
    assert token not in str(lines)
    assert PASSWORD not in str(lines)
    assert typed("audit", "verify", *there).returncode == 0
    assert token not in typed("token", "list", *there).stdout
    stays = typed("user", "password", "ANN", "--password-stdin", *there, given=f"{PASSWORD} 2\n")
    assert "tokens that stay: 1" in stays.stdout
    ended = typed("user", "password", "ann", "--password-stdin", "--revoke-tokens", *there, given=f"{PASSWORD} 3\n")
    assert "sessions and tokens have ended" in ended.stdout
    assert "a script" not in typed("token", "list", *there).stdout


def test_a_server_takes_in_what_is_typed_while_it_runs(tmp_path: Path) -> None:
    there = ("--data-dir", tmp_path)
    typed("user", "add", "ann", "--role", "admin", "--password-stdin", *there, given=f"{PASSWORD}\n")
    with running("serve", "--host", "0.0.0.0", "--port", "0", *there) as (_, url):
        assert httpx.get(f"{url}/api/v1/rigs", timeout=PATIENT_S).status_code == 401
        token = typed("token", "create", "ann", *there).stdout.strip()
        ident = typed("token", "list", *there).stdout.splitlines()[1].split()[0]
        with httpx.Client(
            base_url=f"{url}/api/v1", headers={"Authorization": f"Bearer {token}"}, timeout=PATIENT_S
        ) as ann:
            until(lambda: ann.get("/rigs").is_success, every_s=0.1)
            assert ann.get("/health").json()["authenticated"]
            assert typed("token", "revoke", ident, *there).returncode == 0
            until(lambda: ann.get("/rigs").status_code == 401, every_s=0.1)
