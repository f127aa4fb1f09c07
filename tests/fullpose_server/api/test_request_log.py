"""Requests in the log, in the metrics and by their ids; what runs, and the API's page without a network."""

import logging
import re

import httpx
import pytest

from fullpose_server.api.console import FOLDER
from fullpose_server.version import VERSION
from tests.fullpose_server.api.live_server import LiveServer
from tests.support.waiting import until

ID = "0123456789abcdef0123456789abcdef"


def test_an_answer_has_the_id_that_its_entry_has(server: LiveServer, caplog: pytest.LogCaptureFixture) -> None:
    with caplog.at_level(logging.INFO, "fullpose_server.api.request_log"):
        answer = server.http.get("/plans/no such%0Aplan", headers={"X-Request-ID": ID})
        assert answer.headers["x-request-id"] == ID
        (told,) = until(lambda: [r.getMessage() for r in caplog.records if "no such" in r.getMessage()])
    assert re.fullmatch(r"GET '/api/v1/plans/no such\\nplan' 404 in [\d.]+ ms, from 127\.0\.0\.1", told)


@pytest.mark.parametrize("sent", ["", "one", "../../etc", "f" * 4000])
def test_what_is_no_id_is_replaced(server: LiveServer, sent: str) -> None:
    answer = server.http.get("/version", headers={"X-Request-ID": sent})
    assert re.fullmatch(r"[0-9a-f]{32}", answer.headers["x-request-id"])


def test_requests_are_counted_by_route_and_not_by_what_a_client_calls_it(server: LiveServer) -> None:
    for name in ("one", "two", "three"):
        server.http.get(f"/plans/{name}")
        httpx.get(f"{server.url}/api/v1/{name}")
    text = httpx.get(f"{server.url}/metrics").text
    assert re.search(
        r'fullpose_request_seconds_count\{method="GET",route="[^"]*/plans/\{[a-z_]+\}",status="404"\} ', text
    )
    assert re.search(r'fullpose_request_seconds_count\{method="GET",route="none",status="404"\} ', text)
    assert "/three" not in text
    assert f'fullpose_build_info{{version="{VERSION}"}} 1.0' in text
    assert 'fullpose_jobs_pending{kind="plans"} 0.0' in text


def test_what_runs(server: LiveServer) -> None:
    told = server.http.get("/version").json()
    assert (told["version"], told["api"]) == (VERSION, "/api/v1")


def test_the_api_page_asks_no_other_host(server: LiveServer) -> None:
    page = httpx.get(f"{server.url}/api/docs").text
    addresses = re.findall(r'(?:src|href)="([^"]+)"', page)
    assert len(addresses) == 3
    for address in addresses:
        assert address.startswith("/")
        if (FOLDER / "index.html").is_file():
            assert httpx.get(f"{server.url}{address}").status_code == 200
