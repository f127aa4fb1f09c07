"""Plans and rig files that were edited on the server's disk, as an operator meets them."""

import json
from pathlib import Path
from typing import Any

from tests.fullpose_server.api.live_server import LiveServer, Operator

RIG = """name = "mine"
geometry = "vertical-4"
[frames.base]
max_rate_deg_s = {rate}
max_acceleration_deg_s2 = 500.0
"""


def edited(server: LiveServer, plan: str, **changes: Any) -> Path:
    path = server.settings.data_dir / "plans" / plan / "plan.json"
    content = json.loads(path.read_text()) | changes
    path.write_text(json.dumps({key: value for key, value in content.items() if value is not None}))
    return path


def test_a_plan_whose_rate_was_edited_is_refused_with_the_file_and_the_key(
    server: LiveServer, operator: Operator
) -> None:
    plan = server.plan()
    edited(server, plan["id"], rate_hz=250.0)
    answer = operator.command("load", plan=plan["id"])
    assert (answer.status_code, answer.json()["type"]) == (409, "urn:fullpose:problem:bad-plan")
    assert answer.json()["detail"] == "plan.json: rate_hz: not as the plan was made: make the plan again"
    edited(server, plan["id"], rate_hz=500.0)
    assert operator.command("load", plan=plan["id"]).status_code == 200
    edited(server, plan["id"], lead_in_samples=3)
    answer = operator.command("arm")
    assert (answer.status_code, operator.session()["state"]) == (409, "ready")
    assert "plan.json: lead_in_samples: not as the plan was made" in answer.json()["detail"]


def test_a_plan_of_an_earlier_server_is_shown_and_says_that_it_must_be_made_again(
    server: LiveServer, operator: Operator
) -> None:
    plan = server.plan()
    path = edited(server, plan["id"], format=None, sealed=None)
    shown = server.http.get(f"/plans/{plan['id']}/samples")
    assert shown.status_code == 200
    answer = operator.command("load", plan=plan["id"])
    assert (answer.status_code, answer.json()["type"]) == (409, "urn:fullpose:problem:bad-plan")
    assert "format 1" in answer.json()["detail"]
    assert answer.json()["detail"].endswith("make the plan again")
    assert path.is_file()  # it is not damaged, and not in quarantine


def test_a_rig_whose_file_was_edited_under_its_process_is_neither_loaded_nor_armed(server: LiveServer) -> None:
    path = server.settings.data_dir / "rigs" / "mine.toml"
    path.write_text(RIG.format(rate=200.0))
    operator = Operator(server, "mine")
    operator.to_idle()
    plan = server.plan("mine")
    assert operator.command("load", plan=plan["id"]).status_code == 200
    path.write_text(RIG.format(rate=100.0))
    answer = operator.command("arm")
    assert (answer.status_code, answer.json()["type"]) == (409, "urn:fullpose:problem:rig-changed")
    assert "restart the server" in answer.json()["detail"]
    path.write_text("no TOML")  # of a file that is no rig nothing is known: the rig flies as it was started
    assert operator.command("arm").status_code == 200
    operator.to_idle()
    path.unlink()
