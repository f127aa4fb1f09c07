"""Tags and notes of flights, plans and runs: put there by operators, found by search, told to the audit."""

from pathlib import Path
from typing import Any

import pytest

from fullpose_server.runtime.recording.run_index import RunFiles
from fullpose_server.runtime.recording.run_labels import LABELS
from tests.fullpose_server.api.live_server import FLIGHT, LiveServer
from tests.support.waiting import until


def listed(server: LiveServer, kind: str, **query: str) -> list[str]:
    """What is found: the ids."""
    answer = server.http.get(f"/{kind}", params=query)
    assert answer.status_code == 200, answer.text
    return [str(row.get("id", row.get("sha256"))) for row in answer.json()]


@pytest.fixture(scope="module")
def labelled(server: LiveServer, run: str) -> dict[str, str]:
    """A flight, its plan and its run, each with a tag of its own; another flight beside them."""
    plan = server.http.get(f"/runs/{run}").json()["plan_id"]
    flight = server.http.get(f"/plans/{plan}").json()["trajectory"]
    made = {"trajectories": flight, "plans": plan, "runs": run}
    for kind, each in made.items():
        body = {"tags": ["Customer A", kind], "notes": f"about {kind}"}
        answer = server.http.patch(f"/{kind}/{each}", json=body)
        assert answer.status_code == 200, answer.text
        assert (answer.json()["tags"], answer.json()["notes"]) == (body["tags"], body["notes"])
    server.plan(text=FLIGHT.replace("0.02,", "0.021,", 1))
    return made


@pytest.mark.parametrize("kind", ["trajectories", "plans", "runs"])
def test_each_is_found_by_its_tag_and_its_words(server: LiveServer, labelled: dict[str, str], kind: str) -> None:
    mine = [labelled[kind]]
    assert listed(server, kind, tag="customer a") == mine
    assert listed(server, kind, tag=kind) == mine
    assert listed(server, kind, tag="customer") == []
    assert listed(server, kind, q="ABOUT tomer") == mine
    assert listed(server, kind, q="nothing of the kind") == []
    assert listed(server, kind, q=f"about {kind}", tag="CUSTOMER A") == mine
    assert len(server.http.get(f"/{kind}").json()) >= len(mine)


def test_a_plan_and_a_run_are_found_by_what_is_their_flight_s(server: LiveServer, labelled: dict[str, str]) -> None:
    assert listed(server, "plans", tag="trajectories") == [labelled["plans"]]
    assert listed(server, "runs", tag="trajectories") == [labelled["runs"]]
    assert listed(server, "runs", tag="plans") == [labelled["runs"]]
    assert listed(server, "runs", q="vertical-4 ann completed") == [labelled["runs"]]


def test_a_search_goes_on_in_its_pages(server: LiveServer, labelled: dict[str, str]) -> None:
    answer = server.http.get("/plans", params={"q": "exact", "limit": 1})
    (first,) = answer.json()
    following = server.http.get(f"{server.url}{answer.links['next']['url']}")
    assert "q=exact" in answer.links["next"]["url"]
    assert [row["id"] for row in following.json()] != [first["id"]]


def test_what_is_left_out_stays_and_what_cannot_be_changes_nothing(
    server: LiveServer, labelled: dict[str, str]
) -> None:
    for kind, each in labelled.items():
        before = server.http.get(f"/{kind}/{each}").json()
        assert server.http.patch(f"/{kind}/{each}", json={"notes": before["notes"]}).json()["tags"] == before["tags"]
        wrong: list[dict[str, Any]] = [
            {"tags": ["a,b"]},
            {"tags": "a"},
            {"notes": "\0"},
            {"tag": ["a"]},
            {"tags": [""]},
        ]
        for body in wrong:
            refused = server.http.patch(f"/{kind}/{each}", json=body)
            assert refused.status_code == 422, (body, refused.text)
        assert server.http.get(f"/{kind}/{each}").json() == before
        assert server.http.patch(f"/{kind}/{'0' * 64}", json={"tags": []}).status_code == 404
    assert server.http.get("/runs", params={"q": "a " * 17}).status_code == 422


def test_who_labelled_what_is_in_the_audit(server: LiveServer, labelled: dict[str, str]) -> None:
    def lines() -> set[str]:
        return {row["command"] for row in server.http.get("/audit", params={"limit": 1000}).json()}

    wanted = {"PATCH /trajectories/{sha256}", "PATCH /plans/{plan}", "PATCH /runs/{run}"}
    until(lambda: wanted <= lines())


def test_a_plan_s_hash_stays_what_it_is(server: LiveServer, labelled: dict[str, str]) -> None:
    path = f"/plans/{labelled['plans']}"
    before = server.http.get(path).json()["plan_hash"]
    assert server.http.patch(path, json={"notes": "other"}).json()["plan_hash"] == before
    server.http.patch(path, json={"notes": "about plans"})


def test_labels_of_runs_are_files_beside_the_records(server: LiveServer, labelled: dict[str, str]) -> None:
    folder = server.settings.data_dir / "runs"
    again = RunFiles(folder)
    assert again.labels.get(labelled["runs"]).tags == ("Customer A", "runs")
    assert folder / f"{labelled['runs']}{LABELS}" in again.files(labelled["runs"])


def test_a_label_file_that_is_none_says_nothing(tmp_path: Path) -> None:
    for number, content in enumerate(
        ("", "[]", '{"tags": 3}', '{"tags": [1], "notes": ""}', '{"tags": ["a,b"], "notes": ""}')
    ):
        (tmp_path / f"r{number}{LABELS}").write_text(content)
    assert RunFiles(tmp_path).labels.get("r0").tags == ()
