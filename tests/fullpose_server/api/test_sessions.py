"""A session through HTTP, on a real rig process: what is allowed, what is refused, and what the audit says."""

from typing import Any

import pytest

from fullpose_server.session.states import State
from fullpose_server.session.table import allowed
from tests.fullpose_server.api.live_server import LiveServer, Operator


def refused(answer: Any, status: int = 409) -> dict[str, Any]:
    assert answer.status_code == status, answer.text
    assert answer.headers["content-type"] == "application/problem+json"
    body: dict[str, Any] = answer.json()
    return body


def test_a_rig_without_a_process_is_disconnected_and_says_what_can_be_done(server: LiveServer) -> None:
    session = server.http.get("/rigs/horizontal-4/session").json()
    assert (session["state"], session["allowed"], session["health"]["rig_alive"]) == (
        "disconnected",
        ["connect"],
        False,
    )
    for word, category in (("stop", 2), ("estop", 1)):  # never refused: what is not known is told
        told = server.http.post(f"/rigs/horizontal-4/{word}")
        assert (told.status_code, told.json()["stop_category"]) == (202, category)
        assert "no rig process runs" in told.json()["unknown"]
    # Refused without starting one.
    for word, status, code in (("arm", 409, "illegal-command"), ("connect", 403, "lease-needed")):
        body = refused(server.http.post("/rigs/horizontal-4/commands", json={"command": word}), status)
        assert body["type"].endswith(code)
        assert (body["state"], body["allowed"]) == ("disconnected", ["connect"])
    assert "horizontal-4" not in server.http.get("/health").json()["rigs"]
    assert [line["accepted"] for line in server.http.get("/audit", params={"rig": "horizontal-4"}).json()] == [
        False,
        False,
        True,
        True,
    ]
    assert refused(server.http.get("/rigs/nowhere/session"), 404)["type"].endswith("not-found")


def test_a_flight_from_upload_to_its_end_with_hold_resume_and_audit(operator: Operator, server: LiveServer) -> None:
    plan = server.plan()
    assert plan["flyable"], plan["refusal"]
    loaded = operator.command("load", plan=plan["id"])
    assert loaded.json()["state_after"] == "ready", loaded.text
    assert operator.session()["plan"]["plan_hash"] == plan["plan_hash"]
    pair = {"plan_hash": plan["plan_hash"], "rig_hash": plan["rig_hash"]}
    assert operator.command("arm", **pair).json()["state_after"] == "armed"
    assert operator.command("start").json()["state_after"] == "positioning"
    operator.wait("running")
    assert operator.command("hold").json()["state_after"] == "held"
    assert operator.command("resume").json()["state_after"] == "running"
    session = operator.wait("armed")
    assert [a["code"] for a in session["alarms"] if a["severity"] != "warning"] == []  # a starved machine may be late
    log = server.http.get("/audit", params={"rig": "vertical-4", "limit": 5}).json()
    assert [(line["command"], line["state_before"], line["state_after"]) for line in reversed(log)] == [
        ("load", "idle", "ready"),
        ("arm", "ready", "armed"),
        ("start", "armed", "positioning"),
        ("hold", "running", "held"),
        ("resume", "held", "running"),
    ]
    assert {line["who"] for line in log} == {"ann"}
    assert all(line["accepted"] and line["lease_epoch"] == operator.epoch for line in log)
    assert log[4]["args"] == {"plan": plan["id"]}


def test_an_illegal_command_changes_nothing_and_says_what_is_allowed(operator: Operator, server: LiveServer) -> None:
    before = operator.session()
    body = refused(operator.command("start"))
    assert (body["type"], body["state"], body["command"]) == ("urn:fullpose:problem:illegal-command", "idle", "start")
    assert body["allowed"] == [str(command) for command in allowed(State.IDLE)]
    after = operator.session()
    assert (after["state"], after["plan"]) == (before["state"], before["plan"])
    line = server.http.get("/audit", params={"limit": 1}).json()[0]
    assert (line["command"], line["accepted"], line["state_before"], line["state_after"]) == (
        "start",
        False,
        "idle",
        "idle",
    )
    assert line["detail"].startswith("illegal_command")


def test_without_the_lease_only_stop_and_estop(operator: Operator, server: LiveServer) -> None:
    url = "/rigs/vertical-4"
    body = refused(
        server.http.post(f"{url}/commands", json={"command": "load", "args": {"plan": server.plan()["id"]}}), 403
    )
    assert body["type"].endswith("lease-needed")
    stale = {"command": "unload", "lease": operator.token() | {"sequence": 0}}
    assert refused(server.http.post(f"{url}/commands", json=stale), 409)["type"].endswith("stale-command")
    other = {"X-Fullpose-Client": "bob"}
    assert refused(server.http.post(f"{url}/lease", headers=other))["type"].endswith("lease-held")
    assert server.http.post(f"{url}/lease", json={"action": "request"}, headers=other).json()["requested_by"] == ["bob"]
    assert operator.lease("grant").json()["holder"] == "bob"
    assert server.http.post(f"{url}/estop", headers=other).json()["state_after"] == "estopped"
    operator.take("takeover")
    assert operator.command("acknowledge").status_code == 200
    assert operator.command("reset").json()["state_after"] == "idle"


def test_the_greatest_sequence_is_done_audited_and_the_last_of_its_epoch(
    operator: Operator, server: LiveServer
) -> None:
    operator.sequence = 2**63 - 2
    assert operator.command("acknowledge").status_code == 200
    line = server.http.get("/audit", params={"limit": 1}).json()[0]
    assert (line["command"], line["accepted"], line["lease_sequence"]) == ("acknowledge", True, 2**63 - 1)
    assert refused(operator.command("acknowledge"), 422)["errors"][0]["where"].endswith("lease.sequence")
    assert operator.lease("release").json()["sequence"] == 0


def test_a_late_a_doubled_and_a_former_holder_s_command_are_refused_and_audited(
    operator: Operator, server: LiveServer
) -> None:
    def sent(epoch: int, sequence: int) -> Any:
        lease = {"epoch": epoch, "sequence": sequence, "secret": operator.secret}
        body = {"command": "acknowledge", "lease": lease}
        return server.http.post("/rigs/vertical-4/commands", json=body)

    former = operator.epoch
    operator.lease("release")
    operator.take()
    assert operator.epoch > former
    newest = operator.sequence + 5
    assert sent(operator.epoch, newest).status_code == 200
    assert refused(sent(operator.epoch, newest), 409)["type"].endswith("stale-command")
    assert refused(sent(operator.epoch, newest - 1), 409)["type"].endswith("stale-command")
    assert refused(sent(former, newest + 1), 403)["type"].endswith("lease-lost")
    lines = server.http.get("/audit", params={"limit": 3}).json()
    assert [(line["accepted"], line["lease_epoch"], line["lease_sequence"]) for line in lines] == [
        (False, former, newest + 1),
        (False, operator.epoch, newest - 1),
        (False, operator.epoch, newest),
    ]
    operator.sequence = newest


def test_a_command_that_the_rig_process_would_not_read_whole_is_refused_unsent(
    operator: Operator, server: LiveServer, monkeypatch: pytest.MonkeyPatch
) -> None:
    with monkeypatch.context() as small:
        small.setattr("fullpose_server.runtime.supervisor.control_link.MAX_REQUEST", 200)
        body = refused(operator.command("load", live={"options": {f"option_{k}": 1 for k in range(20)}}), 413)
    assert body["type"].endswith("too-large")
    assert "at most 200" in body["detail"]
    assert operator.command("acknowledge").status_code == 200  # over the same link


def test_stop_brakes_a_move_and_estop_latches(operator: Operator, server: LiveServer) -> None:
    operator.command("load", plan=server.plan()["id"])
    operator.command("arm")
    assert operator.command("move", target_deg=[60.0, 20.0, 0.0, 0.0]).json()["state_after"] == "positioning"
    # A move that has hardly begun is at rest again before the answer is written.
    assert server.http.post("/rigs/vertical-4/stop").json()["state_after"] in ("stopping", "armed")
    operator.wait("armed")
    assert operator.command("jog", frame="base", step_deg=5.0).json()["state_after"] == "positioning"
    assert server.http.post("/rigs/vertical-4/estop").json()["state_after"] == "estopped"
    session = operator.wait("estopped")
    (given,) = [alarm for alarm in session["alarms"] if alarm["severity"] == "emergency"]
    assert given["number"] in [alarm["number"] for alarm in server.http.get("/rigs/vertical-4/alarms").json()]
    operator.wait("estopped")
    assert refused(operator.command("reset"))["type"].endswith(("unacknowledged", "not-at-rest"))


def test_load_takes_only_flyable_plans_of_this_rig(operator: Operator, server: LiveServer) -> None:
    other = server.plan(rig="vertical-limited")
    assert "vertical-limited" in refused(operator.command("load", plan=other["id"]))["detail"]
    assert refused(operator.command("load", plan="nothing"), 404)
    fast = "time_s,yaw_deg,pitch_deg,roll_deg\n" + "".join(f"{k / 50},0,0,{k * 30}\n" for k in range(50))
    plan = server.plan(text=fast)
    assert (plan["status"], plan["feasible"], plan["flyable"]) == ("done", False, False)
    assert plan["refusal"]
    assert plan["report"]["limited_samples"] + plan["report"]["limit_violation_samples"] > 0
    assert plan["refusal"] in refused(operator.command("load", plan=plan["id"]))["detail"]


@pytest.mark.parametrize(
    "body",
    [
        {"command": "fly"},
        {"command": "load"},
        {"command": "load", "args": {"plan": 1}},
        {"command": "move", "args": {"target_deg": [1, 2, 3]}},
        {"command": "arm", "args": {"speed": 1}},
        {"command": "arm", "args": {"plan_hash": "0" * 65}},
        {"command": "arm", "lease": {"epoch": -1, "sequence": 0, "secret": "a"}},
        {"command": "arm", "lease": {"epoch": 2**63, "sequence": 0, "secret": "a"}},
        {"command": "arm", "lease": {"epoch": 0, "sequence": 2**63, "secret": "a"}},
        {"command": "arm", "lease": {"epoch": 0, "sequence": 2**70, "secret": "a"}},
        {"command": "arm", "lease": {"epoch": 0, "sequence": 0}},
        {"command": "arm", "lease": {"epoch": 0, "sequence": 0, "secret": "not a secret"}},
        {"command": "acknowledge", "args": {"numbers": [2**63]}},
        {"command": "acknowledge", "args": {"numbers": list(range(257))}},
        {"command": "load", "args": {"live": {"options": {f"option_{k}": 1 for k in range(8000)}}}},
        {"command": "load", "args": {"live": {"options": {"weight": "x" * 65}}}},
        {},
        [],
    ],
)
def test_a_body_that_is_no_command(server: LiveServer, body: Any) -> None:
    assert refused(server.http.post("/rigs/vertical-4/commands", json=body), 422)["errors"]


def test_a_loaded_plan_stays_until_it_is_unloaded(operator: Operator, server: LiveServer) -> None:
    plan = server.plan()
    operator.command("load", plan=plan["id"])
    assert refused(server.http.delete(f"/plans/{plan['id']}"))["type"].endswith("in-use")
    operator.command("unload")
    assert server.http.delete(f"/plans/{plan['id']}").status_code == 204


def test_metrics_and_health_tell_of_the_rig(operator: Operator, server: LiveServer) -> None:
    text = server.http.get("/metrics").text
    assert 'fullpose_session_state{rig="vertical-4",state="idle"} 1.0' in text
    assert 'fullpose_rig_alive{rig="vertical-4"} 1.0' in text
    health = server.http.get("/health").json()
    assert health["status"] == "ok", health["warnings"]
    assert health["rigs"]["vertical-4"]["ticks"] > 0
